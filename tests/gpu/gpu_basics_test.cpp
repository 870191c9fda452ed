// The GPU layer on a real device, with validation on: pipelines, transfers, aliases, retirement, reload.
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <thread>

#include <unistd.h>

#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/shader_library.h"
#include "runtime/gpu/upload.h"
#include "tests/gpu/test_device.h"

namespace loam::gpu {
namespace {

namespace fs = std::filesystem;
using uint = uint32_t;
#include "shaders/test/fill_io.h"

using GpuBasics = GpuTest;

// Unwraps in tests: a failure is reported with its sentence, then the program cannot go on.
template <typename T>
T need(Result<T> result) {
    LOAM_CHECK(result.ok(), result.ok() ? "" : result.message());
    return std::move(result.value());
}
void need(const Status& status) {
    LOAM_CHECK(status.ok(), status.ok() ? "" : status.message());
}

Buffer storage(const char* name, uint64_t size) {
    return need(Buffer::create(
        test_device(), {.name = name, .size_bytes = size, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
}

Pipeline fill_pipeline(uint32_t extra = 0, std::string shader = "test/fill.comp") {
    return need(Pipeline::create(test_device(), ComputeDesc{.name = "fill",
                                                            .shader = std::move(shader),
                                                            .bindings = {storage_buffer(0)},
                                                            .push_bytes = sizeof(TestFillParams),
                                                            .constants = {{0, extra}}}));
}

std::vector<uint32_t> run_fill(FrameRing& ring, const Pipeline& fill, Buffer& buffer, TestFillParams params) {
    std::vector<uint32_t> got;
    Frame* frame = need(ring.begin());
    {
        auto pass = frame->commands.pass("fill", {{buffer, Access::compute_storage}});
        frame->commands.bind(fill, {{0, buffer}});
        frame->commands.push(fill, params);
        frame->commands.dispatch((params.count + TEST_FILL_GROUP - 1) / TEST_FILL_GROUP);
    }
    ring.read_back(frame->commands, buffer, 0, params.count * 4ull, [&](std::span<const std::byte> bytes) {
        got.resize(bytes.size() / 4);
        std::memcpy(got.data(), bytes.data(), bytes.size());
    });
    need(ring.finish(*frame));
    return got;
}

std::vector<uint32_t> expected_fill(TestFillParams params, uint32_t extra = 0) {
    std::vector<uint32_t> values(params.count);
    for (uint32_t i = 0; i < params.count; ++i) values[i] = i * params.factor + params.addend + extra;
    return values;
}

TEST_F(GpuBasics, ComputeFillsABuffer) {
    auto ring = need(FrameRing::create(test_device(), 2));
    Buffer buffer = storage("values", 1000 * 4);
    const Pipeline plain = fill_pipeline(), extra = fill_pipeline(77);
    const TestFillParams params{1000, 3, 11};
    EXPECT_EQ(run_fill(*ring, plain, buffer, params), expected_fill(params));
    EXPECT_EQ(run_fill(*ring, extra, buffer, params), expected_fill(params, 77));
    ASSERT_EQ(ring->pass_times().size(), 1u);
    EXPECT_EQ(ring->pass_times()[0].name, "fill");
    EXPECT_GT(ring->ring_bytes(), 0u);
}

TEST_F(GpuBasics, ReadbacksComeInOrderWithoutFinish) {
    auto ring = need(FrameRing::create(test_device(), 3));
    Buffer buffer = storage("values", 4096);
    std::vector<uint32_t> seen;
    for (uint32_t i = 0; i < 20; ++i) {
        Frame* frame = need(ring->begin());
        const UploadSlice slice = ring->upload(4);
        *slice.as<uint32_t>() = i;
        EXPECT_EQ(slice.offset % 256, 0u);
        frame->commands.use({{buffer, Access::copy_target}});
        const VkBufferCopy region{slice.offset, 0, 4};
        vkCmdCopyBuffer(frame->commands.handle(), slice.buffer->handle(), buffer.handle(), 1, &region);
        ring->read_back(frame->commands, buffer, 0, 4, [&seen](std::span<const std::byte> bytes) {
            uint32_t value = 0;
            std::memcpy(&value, bytes.data(), 4);
            seen.push_back(value);
        });
        need(i == 19 ? ring->finish(*frame) : ring->end(*frame));
    }
    std::vector<uint32_t> all(20);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(seen, all);
}

TEST_F(GpuBasics, ManyBindsAndBigUploadsGrow) {
    auto ring = need(FrameRing::create(test_device(), 2));
    Buffer buffer = storage("values", 64 * 4);
    const Pipeline fill = fill_pipeline();
    for (int round = 0; round < 4; ++round) {
        Frame* frame = need(ring->begin());
        const UploadSlice big = ring->upload(9 << 20);
        std::memset(big.data, 1, big.size_bytes);
        for (int i = 0; i < 600; ++i) {  // more sets than one pool holds
            auto pass = frame->commands.pass("fill", {{buffer, Access::compute_storage}});
            frame->commands.bind(fill, {{0, buffer}});
            frame->commands.push(TestFillParams{64, 1, 0});
            frame->commands.dispatch(1);
        }
        need(ring->finish(*frame));
    }
    EXPECT_LT(ring->ring_bytes(), 40u << 20);
}

std::vector<std::byte> pattern(size_t size) {
    std::vector<std::byte> bytes(size);
    for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>((i * 37 + i / 256) & 0xff);
    return bytes;
}

TEST_F(GpuBasics, ImagesComeBackAsTheyWent) {
    auto ring = need(FrameRing::create(test_device(), 2));
    struct Case {
        VkFormat format;
        uint32_t size;
        size_t bytes;
    };
    for (const Case c :
         {Case{VK_FORMAT_R8G8B8A8_UNORM, 37, 37 * 37 * 4}, Case{VK_FORMAT_R32_SFLOAT, 68, 68 * 68 * 4},
          Case{VK_FORMAT_BC1_RGBA_UNORM_BLOCK, 64, 16 * 16 * 8}}) {
        if (c.format == VK_FORMAT_BC1_RGBA_UNORM_BLOCK && !test_device().caps().bc) continue;
        Image image = need(Image::create(test_device(), {.name = "round trip",
                                                         .format = c.format,
                                                         .width = c.size,
                                                         .height = c.size,
                                                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
        const auto sent = pattern(c.bytes);
        std::vector<std::byte> got;
        Frame* frame = need(ring->begin());
        upload_to_image(*ring, frame->commands, image, 0, 0, 0, 0, c.size, c.size, sent);
        frame->commands.use({{image, Access::compute_sampled}});
        frame->commands.use({{image, Access::fragment_sampled}});
        ring->read_back(frame->commands, image, [&](auto bytes) { got.assign(bytes.begin(), bytes.end()); });
        need(ring->finish(*frame));
        EXPECT_EQ(got, sent) << c.format;
    }
}

TEST_F(GpuBasics, BlocksAreWrittenThroughAnAlias) {
    if (!test_device().caps().bc) GTEST_SKIP() << "no BC formats";
    auto ring = need(FrameRing::create(test_device(), 2));
    Image image =
        need(Image::create(test_device(), {.name = "blocks",
                                           .format = VK_FORMAT_BC1_RGBA_UNORM_BLOCK,
                                           .width = 128,
                                           .height = 64,
                                           .mip_count = 2,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT,
                                           .alias_format = VK_FORMAT_R32G32_UINT}));
    const Pipeline blocks = need(Pipeline::create(test_device(), ComputeDesc{.name = "blocks",
                                                                             .shader = "test/blocks.comp",
                                                                             .bindings = {storage_image(0)},
                                                                             .constants = {}}));
    std::vector<uint32_t> got;
    Frame* frame = need(ring->begin());
    {
        auto pass = frame->commands.pass("blocks", {{image, Access::compute_storage}});
        for (uint32_t mip = 0; mip < 2; ++mip) {
            frame->commands.bind(blocks, {{0, image.alias_view(mip)}});
            frame->commands.dispatch(4, 2);
        }
    }
    ring->read_back(frame->commands, image, [&](std::span<const std::byte> bytes) {
        got.resize(bytes.size() / 4);
        std::memcpy(got.data(), bytes.data(), bytes.size());
    });
    need(ring->finish(*frame));
    ASSERT_EQ(got.size(), 32u * 16 * 2);
    for (uint32_t y = 0; y < 16; ++y)
        for (uint32_t x = 0; x < 32; ++x) {
            ASSERT_EQ(got[(y * 32 + x) * 2], x * 1000 + y);
            ASSERT_EQ(got[(y * 32 + x) * 2 + 1], ~x);
        }
}

struct CoverParams {
    float color[4];
    float depth;
};

TEST_F(GpuBasics, DrawsWithDepthThenSamplesTheResult) {
    Device& device = test_device();
    auto ring = need(FrameRing::create(device, 2));
    constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM;
    const ImageDesc target{.name = "color",
                           .format = kColor,
                           .width = 32,
                           .height = 16,
                           .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    Image color = need(Image::create(device, target)), copy = need(Image::create(device, target));
    Image depth = need(Image::create(
        device, {.name = "depth",
                 .format = device.caps().depth_stencil,
                 .width = 32,
                 .height = 16,
                 .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}));
    EXPECT_NE(depth.depth_view(), VkImageView(VK_NULL_HANDLE));
    EXPECT_NE(depth.stencil_view(), VkImageView(VK_NULL_HANDLE));
    const Sampler nearest = need(Sampler::create(device, {.filter = VK_FILTER_NEAREST}));
    GraphicsDesc desc;
    desc.name = "cover";
    desc.vertex_shader = "test/cover.vert";
    desc.fragment_shader = "test/cover.frag";
    desc.push_bytes = sizeof(CoverParams);
    desc.color_formats = {kColor};
    desc.depth_format = device.caps().depth_stencil;
    desc.depth_test = desc.depth_write = true;
    const Pipeline cover = need(Pipeline::create(device, desc));
    GraphicsDesc sample;
    sample.name = "sample";
    sample.vertex_shader = "test/cover.vert";
    sample.fragment_shader = "test/sample.frag";
    sample.bindings = {sampled_image(0)};
    sample.push_bytes = sizeof(CoverParams);
    sample.color_formats = {kColor};
    const Pipeline copy_pipeline = need(Pipeline::create(device, sample));

    std::vector<std::byte> got;
    for (int round = 0; round < 2; ++round) {  // twice: the second begins from the states the first left
        Frame* frame = need(ring->begin());
        Commands& commands = frame->commands;
        {
            auto pass =
                commands.pass("cover", {{color, Access::color_target}, {depth, Access::depth_target}});
            const ColorTarget colors[] = {{color.mip_view(0), VK_ATTACHMENT_LOAD_OP_CLEAR}};
            commands.begin_rendering(
                {32, 16}, colors,
                {.view = depth.mip_view(0), .load = VK_ATTACHMENT_LOAD_OP_CLEAR, .has_stencil = true});
            commands.bind(cover, std::span<const Bound>{});
            commands.push(CoverParams{{1.0f, 0.0f, 0.0f, 1.0f}, 0.75f});
            commands.draw(3);
            commands.push(CoverParams{{0.0f, 1.0f, 0.0f, 1.0f}, 0.25f});  // behind, in reversed Z
            commands.draw(3);
            commands.end_rendering();
        }
        {
            auto pass =
                commands.pass("sample", {{color, Access::fragment_sampled}, {copy, Access::color_target}});
            const ColorTarget colors[] = {{copy.mip_view(0), VK_ATTACHMENT_LOAD_OP_DONT_CARE}};
            commands.begin_rendering({32, 16}, colors);
            commands.bind(copy_pipeline, {{0, color.view(), nearest}});
            commands.push(CoverParams{});
            commands.draw(3);
            commands.end_rendering();
        }
        ring->read_back(commands, copy, [&](auto bytes) { got.assign(bytes.begin(), bytes.end()); });
        need(ring->finish(*frame));
    }
    ASSERT_EQ(got.size(), 32u * 16 * 4);
    for (size_t i = 0; i < got.size(); ++i) ASSERT_EQ(int(got[i]), i % 4 == 0 || i % 4 == 3 ? 255 : 0) << i;
}

TEST_F(GpuBasics, RetiredObjectsLiveUntilTheirFrameHasPassed) {
    Device& device = test_device();
    auto ring = need(FrameRing::create(device, 2));
    device.collect(device.finished_frame());
    const uint64_t before = device.allocated_bytes(MemoryUse::device);
    {
        Buffer idle = storage("idle", 1 << 20);
        EXPECT_GT(device.allocated_bytes(MemoryUse::device), before);
    }
    EXPECT_EQ(device.allocated_bytes(MemoryUse::device), before) << "no frame is in flight: freed at once";

    Frame* frame = need(ring->begin());
    {
        Buffer used = storage("used", 1 << 20);
        const Pipeline fill = fill_pipeline();
        auto pass = frame->commands.pass("fill", {{used, Access::compute_storage}});
        frame->commands.bind(fill, {{0, used}});
        frame->commands.push(TestFillParams{64, 1, 0});
        frame->commands.dispatch(1);
        Buffer moved = std::move(used);
    }
    EXPECT_GT(device.allocated_bytes(MemoryUse::device), before) << "the frame may still use it";
    need(ring->finish(*frame));
    EXPECT_EQ(device.allocated_bytes(MemoryUse::device), before);
}

TEST_F(GpuBasics, ImpossibleImagesAreASentence) {
    const auto image = Image::create(test_device(), {.name = "vast",
                                                     .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                     .width = 1 << 20,
                                                     .height = 4,
                                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    ASSERT_FALSE(image.ok());
    EXPECT_NE(image.message().find("\"vast\" is 1048576 x 4"), std::string::npos) << image.message();
}

TEST_F(GpuBasics, AnUnknownDeviceNamesThoseThereAre) {
    const auto device = Device::create({.device_filter = "no such device", .instance_extensions = {}});
    ASSERT_FALSE(device.ok());
    EXPECT_NE(device.message().find(test_device().caps().name), std::string::npos) << device.message();
}

TEST(ShaderCompile, ErrorsGiveNameAndLine) {
    const auto shader =
        glsl::compile("test/bad.comp", "#version 460\n\nvoid main() { x = 1; }\n", glsl::embedded_text);
    ASSERT_FALSE(shader.ok());
    EXPECT_TRUE(shader.message().starts_with("test/bad.comp:3: ")) << shader.message();
    EXPECT_EQ(shader.message().find("compilation errors"), std::string::npos) << shader.message();
    EXPECT_FALSE(glsl::compile("test/bad.txt", "", glsl::embedded_text).ok());
}

// A folder as the repository has it: include root, and shaders/test below it.
class TemporaryShaders {
  public:
    TemporaryShaders() : root_(fs::temp_directory_path() / fmt::format("loam-reload-{}", ::getpid())) {
        fs::create_directories(shaders() / "test");
    }
    ~TemporaryShaders() {
        std::error_code ignored;
        fs::remove_all(root_, ignored);
    }
    [[nodiscard]] fs::path shaders() const { return root_ / "shaders"; }
    void write(const std::string& name, const std::string& text) {
        // A file system's clock may be coarse: wait until the time of the file is another.
        const auto before =
            fs::exists(shaders() / name) ? fs::last_write_time(shaders() / name) : fs::file_time_type{};
        do {
            std::ofstream(shaders() / name, std::ios::trunc) << text;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while (fs::last_write_time(shaders() / name) == before);
    }

  private:
    fs::path root_;
};

std::string fill_source(const std::string& value) {
    return "#version 460\n#extension GL_GOOGLE_include_directive : require\n"
           "#include \"shaders/test/header.h\"\n"
           "layout(local_size_x = 64) in;\n"
           "layout(set = 0, binding = 0) buffer Values { uint values[]; };\n"
           "layout(push_constant) uniform Params { uint count, factor, addend; };\n"
           "void main() { const uint i = gl_GlobalInvocationID.x; if (i < count) values[i] = " +
           value + "; }\n";
}

TEST_F(GpuBasics, ChangedShadersRebuildTheirPipelines) {
    Device& device = test_device();
    auto ring = need(FrameRing::create(device, 2));
    TemporaryShaders folder;
    folder.write("test/header.h", "#define FACTOR 5\n");
    folder.write("test/fill.comp", fill_source("i"));
    ShaderLibrary& library = device.shaders();
    library.watch(folder.shaders());
    Buffer buffer = storage("values", 64 * 4);
    const Pipeline fill = fill_pipeline();
    const TestFillParams params{64, 2, 1};
    EXPECT_TRUE(library.poll().empty());
    EXPECT_EQ(run_fill(*ring, fill, buffer, params), expected_fill(params));  // still what was embedded

    folder.write("test/fill.comp", fill_source("i * FACTOR"));
    auto changed = library.poll();
    ASSERT_EQ(changed, std::vector<std::string>{"test/fill.comp"});
    reload_pipelines(device, changed);
    EXPECT_EQ(run_fill(*ring, fill, buffer, params), expected_fill({64, 5, 0}));

    folder.write("test/fill.comp", fill_source("i * nothing"));
    changed = library.poll();
    EXPECT_TRUE(changed.empty());
    reload_pipelines(device, changed);
    ASSERT_EQ(library.errors().size(), 1u);
    EXPECT_TRUE(library.errors().at("test/fill.comp").starts_with("test/fill.comp:7: "))
        << library.errors().at("test/fill.comp");
    EXPECT_EQ(run_fill(*ring, fill, buffer, params), expected_fill({64, 5, 0}));

    folder.write("test/fill.comp", fill_source("i * FACTOR"));
    EXPECT_TRUE(library.poll().empty()) << "the code is what it was";
    EXPECT_TRUE(library.errors().empty());
    folder.write("test/header.h", "#define FACTOR 9\n");  // what a shader includes counts
    changed = library.poll();
    ASSERT_EQ(changed.size(), 1u);
    reload_pipelines(device, changed);
    EXPECT_EQ(run_fill(*ring, fill, buffer, params), expected_fill({64, 9, 0}));
    folder.write("test/header.h", "#define FACTOR nonsense +\n");
    EXPECT_TRUE(library.poll().empty());
    EXPECT_EQ(library.errors().size(), 1u);
}

}  // namespace
}  // namespace loam::gpu
