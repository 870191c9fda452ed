#include "runtime/gpu/pipeline.h"

#include <algorithm>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/gpu/format.h"
#include "runtime/gpu/pipeline_state.h"
#include "runtime/gpu/shader_library.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

namespace {

constexpr uint32_t kMaxPush_bytes = 128;  // what Vulkan guarantees

// A shader module for the duration of one pipeline's creation.
class Module {
  public:
    explicit Module(VkDevice device) : device_(device) {}
    ~Module() { vkDestroyShaderModule(device_, module_, nullptr); }
    Module(const Module&) = delete;
    Module& operator=(const Module&) = delete;

    Status load(Device& device, const std::string& shader) {
        auto words = device.shaders().spirv(shader);
        if (!words) return words.error();
        auto info = vk_struct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = words->size_bytes();
        info.pCode = words->data();
        const VkResult r = vkCreateShaderModule(device_, &info, nullptr, &module_);
        if (r != VK_SUCCESS) return vk_error(fmt::format("loading shader {}", shader), r);
        return {};
    }
    [[nodiscard]] VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit,
                                                        const VkSpecializationInfo& constants) const {
        auto info =
            vk_struct<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
        info.stage = bit;
        info.module = module_;
        info.pName = "main";
        info.pSpecializationInfo = &constants;
        return info;
    }

  private:
    VkDevice device_;
    VkShaderModule module_ = VK_NULL_HANDLE;
};

struct Constants {
    explicit Constants(const std::vector<SpecConstant>& list) {
        for (const SpecConstant& c : list) {
            entries.push_back({c.id, static_cast<uint32_t>(values.size() * 4), 4});
            values.push_back(c.value);
        }
        info.mapEntryCount = static_cast<uint32_t>(entries.size());
        info.pMapEntries = entries.data();
        info.dataSize = values.size() * 4;
        info.pData = values.data();
    }
    Constants(const Constants&) = delete;
    Constants& operator=(const Constants&) = delete;
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    VkSpecializationInfo info{};
};

VkPipelineColorBlendAttachmentState blend_state(Blend blend, VkColorComponentFlags mask) {
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask = mask;
    state.blendEnable = blend != Blend::none;
    state.srcColorBlendFactor = blend == Blend::alpha ? VK_BLEND_FACTOR_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
    state.dstColorBlendFactor =
        blend == Blend::additive ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    state.dstAlphaBlendFactor = state.dstColorBlendFactor;
    return state;
}

Result<VkPipeline> build_compute(Device& device, const ComputeDesc& desc, VkPipelineLayout layout) {
    Module module(device.handle());
    LOAM_TRY(module.load(device, desc.shader));
    const Constants constants(desc.constants);
    auto info = vk_struct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT, constants.info);
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult r =
        vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline);
    if (r != VK_SUCCESS) return vk_error(fmt::format("building pipeline \"{}\"", desc.name), r);
    return pipeline;
}

Result<VkPipeline> build_graphics(Device& device, const GraphicsDesc& desc, VkPipelineLayout layout) {
    Module vertex(device.handle()), fragment(device.handle());
    LOAM_TRY(vertex.load(device, desc.vertex_shader));
    const bool has_fragment = !desc.fragment_shader.empty();
    if (has_fragment) LOAM_TRY(fragment.load(device, desc.fragment_shader));
    const Constants constants(desc.constants);
    const VkPipelineShaderStageCreateInfo stages[] = {
        vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, constants.info),
        fragment.stage(VK_SHADER_STAGE_FRAGMENT_BIT, constants.info)};

    auto input = vk_struct<VkPipelineVertexInputStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    auto assembly = vk_struct<VkPipelineInputAssemblyStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = desc.topology;
    auto viewport =
        vk_struct<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = viewport.scissorCount = 1;
    auto raster = vk_struct<VkPipelineRasterizationStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.cullMode = desc.cull;
    raster.frontFace = desc.front;
    raster.depthBiasEnable = desc.depth_bias;
    raster.lineWidth = 1.0f;
    auto samples = vk_struct<VkPipelineMultisampleStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    auto depth = vk_struct<VkPipelineDepthStencilStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth.depthTestEnable = desc.depth_test || desc.depth_write;  // writes happen only with the test on
    depth.depthWriteEnable = desc.depth_write;
    depth.depthCompareOp = desc.depth_test ? desc.depth_compare : VK_COMPARE_OP_ALWAYS;
    depth.stencilTestEnable = desc.stencil.enable;
    depth.front = {VK_STENCIL_OP_KEEP,    desc.stencil.pass,      VK_STENCIL_OP_KEEP,
                   desc.stencil.compare,  desc.stencil.read_mask, desc.stencil.write_mask,
                   desc.stencil.reference};
    depth.back = depth.front;

    std::vector<VkPipelineColorBlendAttachmentState> blends;
    for (size_t i = 0; i < desc.color_formats.size(); ++i) {
        constexpr VkColorComponentFlags kAll = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
        blends.push_back(blend_state(desc.blends.empty() ? Blend::none : desc.blends.at(i),
                                     desc.write_masks.empty() ? kAll : desc.write_masks.at(i)));
    }
    auto blend = vk_struct<VkPipelineColorBlendStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = static_cast<uint32_t>(blends.size());
    blend.pAttachments = blends.data();
    const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                             VK_DYNAMIC_STATE_DEPTH_BIAS};
    auto dynamic =
        vk_struct<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = desc.depth_bias ? 3 : 2;
    dynamic.pDynamicStates = dynamic_states;

    auto rendering =
        vk_struct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    rendering.colorAttachmentCount = static_cast<uint32_t>(desc.color_formats.size());
    rendering.pColorAttachmentFormats = desc.color_formats.data();
    if (format_aspect(desc.depth_format) & VK_IMAGE_ASPECT_DEPTH_BIT)
        rendering.depthAttachmentFormat = desc.depth_format;
    if (has_stencil(desc.depth_format)) rendering.stencilAttachmentFormat = desc.depth_format;

    auto info = vk_struct<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.pNext = &rendering;
    info.stageCount = has_fragment ? 2 : 1;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult r =
        vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline);
    if (r != VK_SUCCESS) return vk_error(fmt::format("building pipeline \"{}\"", desc.name), r);
    return pipeline;
}

}  // namespace

Pipeline::State::State(Device& d, std::variant<ComputeDesc, GraphicsDesc> description)
    : device(d), desc(std::move(description)) {
    push_bytes = std::visit([](const auto& known) { return known.push_bytes; }, desc);
    stages = std::holds_alternative<ComputeDesc>(desc)
                 ? VkShaderStageFlags(VK_SHADER_STAGE_COMPUTE_BIT)
                 : VkShaderStageFlags(VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT);
    device.pipelines().add(this);
}

Pipeline::State::~State() {
    device.pipelines().remove(this);
    device.retire([d = device.handle(), pipeline = pipeline, layout = layout, set_layout = set_layout] {
        vkDestroyPipeline(d, pipeline, nullptr);
        vkDestroyPipelineLayout(d, layout, nullptr);
        vkDestroyDescriptorSetLayout(d, set_layout, nullptr);
    });
}

const std::string& Pipeline::State::name() const {
    return std::visit([](const auto& known) -> const std::string& { return known.name; }, desc);
}

std::span<const Binding> Pipeline::State::bindings() const {
    return std::visit([](const auto& known) { return std::span<const Binding>(known.bindings); }, desc);
}

bool Pipeline::State::uses(std::string_view shader) const {
    if (const auto* compute = std::get_if<ComputeDesc>(&desc)) return compute->shader == shader;
    const auto& graphics = std::get<GraphicsDesc>(desc);
    return graphics.vertex_shader == shader || graphics.fragment_shader == shader;
}

Status Pipeline::State::make_layout() {
    LOAM_CHECK(push_bytes <= kMaxPush_bytes && push_bytes % 4 == 0, name());
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (const Binding& b : bindings()) slots.push_back({b.slot, b.type, 1, stages, nullptr});
    auto set =
        vk_struct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = static_cast<uint32_t>(slots.size());
    set.pBindings = slots.data();
    if (const VkResult r = vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &set_layout);
        r != VK_SUCCESS)
        return vk_error("vkCreateDescriptorSetLayout", r);
    const VkPushConstantRange push{stages, 0, push_bytes};
    auto info = vk_struct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout;
    info.pushConstantRangeCount = push_bytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &push;
    if (const VkResult r = vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout); r != VK_SUCCESS)
        return vk_error("vkCreatePipelineLayout", r);
    return {};
}

Status Pipeline::State::build() {
    const auto* compute = std::get_if<ComputeDesc>(&desc);
    auto built = compute ? build_compute(device, *compute, layout)
                         : build_graphics(device, std::get<GraphicsDesc>(desc), layout);
    if (!built) return built.error();
    if (pipeline)
        device.retire([d = device.handle(), old = pipeline] { vkDestroyPipeline(d, old, nullptr); });
    pipeline = *built;
    device.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline), name());
    return {};
}

namespace {
template <typename Desc>
Result<std::unique_ptr<Pipeline::State>> make_state(Device& device, const Desc& desc) {
    auto state = std::make_unique<Pipeline::State>(device, desc);
    LOAM_TRY(state->make_layout());
    LOAM_TRY(state->build());
    return state;
}
}  // namespace

Result<Pipeline> Pipeline::create(Device& device, const ComputeDesc& desc) {
    auto state = make_state(device, desc);
    if (!state) return state.error();
    Pipeline pipeline;
    pipeline.state_ = std::move(*state);
    return pipeline;
}

Result<Pipeline> Pipeline::create(Device& device, const GraphicsDesc& desc) {
    auto state = make_state(device, desc);
    if (!state) return state.error();
    Pipeline pipeline;
    pipeline.state_ = std::move(*state);
    return pipeline;
}

Pipeline::Pipeline() = default;
Pipeline::Pipeline(Pipeline&& other) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&& other) noexcept = default;
Pipeline::~Pipeline() = default;

VkPipeline Pipeline::handle() const {
    return state_->pipeline;
}
VkPipelineLayout Pipeline::layout() const {
    return state_->layout;
}
VkDescriptorSetLayout Pipeline::set_layout() const {
    return state_->set_layout;
}
VkPipelineBindPoint Pipeline::bind_point() const {
    return std::holds_alternative<ComputeDesc>(state_->desc) ? VK_PIPELINE_BIND_POINT_COMPUTE
                                                             : VK_PIPELINE_BIND_POINT_GRAPHICS;
}
VkShaderStageFlags Pipeline::push_stages() const {
    return state_->stages;
}
std::span<const Binding> Pipeline::bindings() const {
    return state_->bindings();
}

void reload_pipelines(Device& device, std::span<const std::string> changed) {
    for (Pipeline::State* state : device.pipelines().live()) {
        const auto used = std::ranges::find_if(changed, [&](const std::string& s) { return state->uses(s); });
        if (used == changed.end()) continue;
        if (Status s = state->build(); !s) device.shaders().report(*used, s.message());
    }
}

}  // namespace loam::gpu
