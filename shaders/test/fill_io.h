// Bindings and parameters of the test shaders, shared with C++.
#define TEST_FILL_GROUP 64

struct TestFillParams {
    uint count;  // values
    uint factor; // value i becomes i * factor + addend
    uint addend;
};
