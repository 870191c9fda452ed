#include "ui/renderer.h"

#include <cstring>

#include "runtime/base/check.h"
#include "runtime/gpu/upload.h"

namespace loam::ui {
namespace {

gpu::GraphicsDesc pipeline_desc(VkFormat format, bool images) {
    return {.name = images ? "ui images" : "ui shapes",
            .vertex_shader = "ui/ui.vert",
            .fragment_shader = "ui/ui.frag",
            .bindings = {gpu::storage_buffer(kUiQuadSlot), gpu::sampled_image(kUiImageSlot)},
            .push_bytes = sizeof(UiPush),
            .constants = {{.id = 0, .value = images ? 1u : 0u}},
            .color_formats = {format},
            .blends = {gpu::Blend::premultiplied},
            .write_masks = {},
            .stencil = {},
            .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP};
}

}  // namespace

UiRenderer::UiRenderer(gpu::Device& device, gpu::Pipeline shapes, gpu::Pipeline images, gpu::Sampler nearest,
                       gpu::Sampler linear)
    : device_(&device),
      shapes_(std::move(shapes)),
      images_(std::move(images)),
      nearest_(std::move(nearest)),
      linear_(std::move(linear)) {}

Result<UiRenderer> UiRenderer::create(gpu::Device& device, VkFormat color_format) {
    auto shapes = gpu::Pipeline::create(device, pipeline_desc(color_format, false));
    if (!shapes) return shapes.error();
    auto images = gpu::Pipeline::create(device, pipeline_desc(color_format, true));
    if (!images) return images.error();
    auto nearest = gpu::Sampler::create(device, {.filter = VK_FILTER_NEAREST});
    if (!nearest) return nearest.error();
    auto linear = gpu::Sampler::create(device, {});
    if (!linear) return linear.error();
    return UiRenderer(device, std::move(*shapes), std::move(*images), std::move(*nearest),
                      std::move(*linear));
}

TextureId UiRenderer::add_image(VkImageView view) {
    const TextureId id = next_id_++;
    views_[id] = view;
    return id;
}

void UiRenderer::set_image(TextureId id, VkImageView view) {
    LOAM_CHECK(views_.contains(id), "set_image of an id that was never added");
    views_[id] = view;
}

void UiRenderer::remove_image(TextureId id) {
    views_.erase(id);
}

Status UiRenderer::upload_atlas(gpu::FrameRing& ring, gpu::Commands& commands, GlyphAtlas& atlas) {
    TexelRect dirty = atlas.take_dirty();
    const auto height = uint32_t(atlas.height());
    if (!atlas_ || atlas_.height() != height) {
        auto image = gpu::Image::create(
            *device_, {.name = "ui glyph atlas",
                       .format = VK_FORMAT_R8_UNORM,
                       .width = uint32_t(atlas.width()),
                       .height = height,
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
        if (!image) return image.error();
        atlas_ = std::move(*image);
        dirty = {0, 0, atlas.width(), atlas.height()};
    }
    if (!dirty.empty()) {
        std::vector<std::byte> rows(size_t(dirty.area()));
        const size_t width = size_t(dirty.width());
        for (int y = dirty.y0; y < dirty.y1; ++y)
            std::memcpy(&rows[size_t(y - dirty.y0) * width],
                        &atlas.pixels()[size_t(y) * size_t(atlas.width()) + size_t(dirty.x0)], width);
        gpu::upload_to_image(ring, commands, atlas_, 0, 0, uint32_t(dirty.x0), uint32_t(dirty.y0),
                             uint32_t(dirty.width()), uint32_t(dirty.height()), rows);
    }
    commands.use({{atlas_, gpu::Access::fragment_sampled}});
    return {};
}

Status UiRenderer::prepare(gpu::FrameRing& ring, gpu::Commands& commands, const DrawList& list,
                           GlyphAtlas& atlas) {
    LOAM_TRY(upload_atlas(ring, commands, atlas));
    runs_.assign(list.runs().begin(), list.runs().end());
    const size_t bytes = list.quads().size_bytes();
    if (bytes == 0) return {};
    quads_ = ring.upload(bytes);
    std::memcpy(quads_.data, list.quads().data(), bytes);
    return {};
}

void UiRenderer::cmd_record(gpu::Commands& commands, VkExtent2D extent) {
    if (extent.width == 0 || extent.height == 0) return;
    const UiPush push{2.0f / float(extent.width), 2.0f / float(extent.height)};
    for (const DrawRun& run : runs_) {
        const bool image = run.texture != kAtlasTexture;
        const gpu::Pipeline& pipeline = image ? images_ : shapes_;
        const auto view = views_.find(run.texture);
        if (image && view == views_.end()) continue;
        commands.bind(pipeline,
                      {{kUiQuadSlot, *quads_.buffer, quads_.offset, quads_.size_bytes},
                       {kUiImageSlot, image ? view->second : atlas_.view(), image ? linear_ : nearest_}});
        commands.push(pipeline, push);
        commands.draw(4, run.count, 0, run.first);
    }
}

}  // namespace loam::ui
