// The one device of a GPU test program, with validation on. Tests derive from GpuTest:
//
//     using TextureCompose = loam::gpu::GpuTest;
//     TEST_F(TextureCompose, MatchesReference) { Device& device = test_device(); … }
//
// Without a device each test is a reported skip. A validation message, leaks at the device's destruction
// included, fails the program. LOAM_TEST_DEVICE chooses a device as --device does.
#pragma once

#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "runtime/base/check.h"
#include "runtime/gpu/device.h"

namespace loam::gpu {

struct TestDevice {
    std::unique_ptr<Device> device;
    std::string reason;  // why there is none
};

inline TestDevice& shared_test_device() {
    static TestDevice shared = [] {
        DeviceDesc desc{.device_filter = {}, .validation = true, .present = false, .instance_extensions = {}};
        if (const char* filter = std::getenv("LOAM_TEST_DEVICE")) desc.device_filter = filter;
        TestDevice made;
        auto device = Device::create(desc);
        if (device.ok())
            made.device = std::move(*device);
        else
            made.reason = device.message();
        return made;
    }();
    return shared;
}

[[nodiscard]] inline Device& test_device() {
    LOAM_CHECK(shared_test_device().device, shared_test_device().reason);
    return *shared_test_device().device;
}

class GpuTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!shared_test_device().device) GTEST_SKIP() << shared_test_device().reason;
    }
};

class ValidationEnvironment : public ::testing::Environment {
  public:
    void TearDown() override {
        shared_test_device().device.reset();
        EXPECT_EQ(total_validation_messages(), 0u);
    }
};
// Registered before main() runs, as gtest_main leaves no other place.
inline ::testing::Environment* const g_validation_environment =
    ::testing::AddGlobalTestEnvironment(new ValidationEnvironment);

}  // namespace loam::gpu
