#include "editor/window/presenter.h"

#include <cmath>

#include "runtime/gpu/upload.h"
#include "shaders/ui/viewport_io.h"

namespace loam::window {

namespace {

void cmd_transition(VkCommandBuffer commands, VkImage image, bool to_target) {
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .pNext = nullptr,
        // The acquire semaphore is waited for at this stage, so the change of layout comes after it.
        .srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
        .srcAccessMask = to_target ? VK_ACCESS_2_NONE : VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
        .dstStageMask = to_target ? VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT : VK_PIPELINE_STAGE_2_NONE,
        .dstAccessMask = to_target ? VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT
                                   : VK_ACCESS_2_NONE,
        .oldLayout = to_target ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .newLayout = to_target ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .pNext = nullptr,
                                      .dependencyFlags = 0,
                                      .memoryBarrierCount = 0,
                                      .pMemoryBarriers = nullptr,
                                      .bufferMemoryBarrierCount = 0,
                                      .pBufferMemoryBarriers = nullptr,
                                      .imageMemoryBarrierCount = 1,
                                      .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
}

VkClearColorValue clear_value(ui::Color c) {
    return {.float32 = {float(c.r) / 255.0f, float(c.g) / 255.0f, float(c.b) / 255.0f, 1.0f}};
}

} // namespace

Presenter::~Presenter() {
    if (gpu::Device* device = session_.device()) device->wait_idle();
    swapchain_.reset();
    if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(session_.device()->instance(), surface_, nullptr);
}

Result<std::unique_ptr<Presenter>> Presenter::create(Session& session, VkSurfaceKHR surface, glm::uvec2 size_px) {
    std::unique_ptr<Presenter> made(new Presenter(session));
    made->surface_ = surface;
    auto swapchain = gpu::Swapchain::create(*session.device(), surface, size_px.x, size_px.y);
    if (!swapchain) return swapchain.error();
    made->swapchain_ = std::move(*swapchain);
    auto ui = ui::UiRenderer::create(*session.device(), made->swapchain_->format());
    if (!ui) return ui.error();
    made->ui_.emplace(std::move(*ui));
    LOAM_TRY(made->make_pipelines());
    return made;
}

Status Presenter::make_pipelines() {
    gpu::Device& device = *session_.device();
    for (const bool filter : {false, true}) {
        auto sampler = gpu::Sampler::create(device, {.filter = filter ? VK_FILTER_LINEAR : VK_FILTER_NEAREST});
        if (!sampler) return sampler.error();
        (filter ? linear_ : nearest_) = std::move(*sampler);
        auto pipeline = gpu::Pipeline::create(device, gpu::GraphicsDesc{.name = filter ? "viewport, filtered" : "viewport",
                                                                        .vertex_shader = "frame/fullscreen.vert",
                                                                        .fragment_shader = "ui/viewport.frag",
                                                                        .bindings = {gpu::sampled_image(0)},
                                                                        .push_bytes = sizeof(ui::ViewportPush),
                                                                        .constants = {{.id = 0, .value = filter ? 1u : 0u}},
                                                                        .color_formats = {swapchain_->format()}});
        if (!pipeline) return pipeline.error();
        (filter ? filtered_ : same_size_) = std::move(*pipeline);
    }
    return {};
}

Result<ui::TextureId> Presenter::set_picture(ui::TextureId id, std::span<const uint8_t> rgba, uint32_t side) {
    LOAM_CHECK(rgba.size() == size_t{4} * side * side, "a picture is square");
    gpu::FrameRing& ring = *session_.ring();
    gpu::Image made;
    if (id == 0) {
        auto image = gpu::Image::create(*session_.device(),
                                        {.name = "layer picture",
                                         .format = VK_FORMAT_R8G8B8A8_UNORM,
                                         .width = side,
                                         .height = side,
                                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
        if (!image) return image.error();
        made = std::move(*image);
    }
    gpu::Image& image = id == 0 ? made : pictures_.at(id);
    auto frame = ring.begin();
    if (!frame) return frame.error();
    gpu::upload_to_image(ring, (*frame)->commands, image, 0, 0, 0, 0, side, side, std::as_bytes(rgba));
    (*frame)->commands.use({{image, gpu::Access::fragment_sampled}});
    LOAM_TRY(ring.end(**frame));
    if (id != 0) return id;
    id = ui_->add_image(made.view());
    pictures_.emplace(id, std::move(made));
    return id;
}

void Presenter::cmd_draw_picture(gpu::Commands& commands, const SceneFrame& scene) {
    const glm::uvec2 filled = scene.renderer->picture_size();
    const ui::Rect& v = scene.viewport;
    if (v.empty() || filled.x == 0 || filled.y == 0) return;
    const bool same = filled == glm::uvec2(std::lround(v.w), std::lround(v.h));
    const gpu::Pipeline& pipeline = same ? same_size_ : filtered_;
    commands.set_viewport(v.x, v.y, v.w, v.h);
    commands.bind(pipeline, {{0, scene.renderer->picture().view(), same ? nearest_ : linear_}});
    commands.push(pipeline, ui::ViewportPush{.origin_x = v.x,
                                             .origin_y = v.y,
                                             .scale_x = float(filled.x) / v.w,
                                             .scale_y = float(filled.y) / v.h,
                                             .size_x = float(filled.x),
                                             .size_y = float(filled.y)});
    commands.draw(3);
}

Result<bool> Presenter::draw(glm::uvec2 size_px, const ui::DrawList& list, ui::GlyphAtlas& atlas, ui::Color background,
                             const std::optional<SceneFrame>& scene) {
    auto target = swapchain_->acquire(size_px.x, size_px.y);
    if (!target) {
        if (target.message().starts_with("window has no area")) return false;
        return target.error();
    }
    gpu::FrameRing& ring = *session_.ring();
    auto frame = ring.begin();
    if (!frame) return frame.error();
    gpu::Commands& commands = (*frame)->commands;

    // The scene, when it is due: all passes of the renderer.
    const glm::uvec2 extent = scene ? glm::uvec2(std::lround(scene->viewport.w), std::lround(scene->viewport.h)) : glm::uvec2(0);
    const bool picture = scene && extent.x > 0 && extent.y > 0;
    if (picture && scene->draw) LOAM_TRY(scene->renderer->render(ring, commands, scene->camera, extent, scene->settings));
    if (picture) commands.use({{scene->renderer->picture(), gpu::Access::fragment_sampled}});
    // Quads and new glyphs of the interface.
    LOAM_TRY(ui_->prepare(ring, commands, list, atlas));

    cmd_transition(commands.handle(), target->image, true);
    {
        const auto pass = commands.pass("window", {});
        const gpu::ColorTarget color{target->view, VK_ATTACHMENT_LOAD_OP_CLEAR, clear_value(background)};
        commands.begin_rendering(target->extent, {&color, 1});
        if (picture) cmd_draw_picture(commands, *scene);
        commands.set_viewport(0, 0, float(target->extent.width), float(target->extent.height));
        ui_->cmd_record(commands, target->extent);
        commands.end_rendering();
    }
    cmd_transition(commands.handle(), target->image, false);
    LOAM_TRY(ring.end(**frame, {.wait_acquired = target->acquired, .signal_rendered = target->rendered}));
    LOAM_TRY(swapchain_->present(*target));
    return true;
}

} // namespace loam::window
