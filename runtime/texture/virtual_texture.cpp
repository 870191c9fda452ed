#include "runtime/texture/virtual_texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "runtime/base/check.h"
#include "runtime/document/document.h"
#include "runtime/texture/distortion.h"
#include "runtime/texture/virtual_texture_impl.h"

namespace loam {

namespace {

using gpu::Access;
constexpr int kRootDivisor = 4;  // at most this part of the physical texture holds roots of live sectors

template <typename T>
Status assign(T& target, Result<T> made) {
    if (!made.ok()) return made.error();
    target = std::move(*made);
    return {};
}

Result<gpu::Buffer> storage_buffer(gpu::Device& device, const char* name, uint64_t bytes) {
    return gpu::Buffer::create(
        device, {.name = name, .size_bytes = bytes, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
}

}  // namespace

VirtualTexture::VirtualTexture() = default;
VirtualTexture::~VirtualTexture() = default;

Status VirtualTexture::Impl::make_resources() {
    Impl& t = *this;
    const uint32_t side = uint32_t(t.desc.pages_per_side);
    LOAM_TRY(assign(t.atlas, make_page_atlas(t.device, t.textures, side, side)));
    LOAM_TRY(assign(
        t.indirection,
        gpu::Image::create(t.device, {.name = "indirection",
                                      .format = VK_FORMAT_R32_UINT,
                                      .width = uint32_t(t.desc.indirection_size) * 3 / 2,
                                      .height = uint32_t(t.desc.indirection_size),
                                      .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                               VK_IMAGE_USAGE_TRANSFER_SRC_BIT})));
    for (EyeState& eye : t.eyes) {
        LOAM_TRY(assign(eye.sector_table,
                        storage_buffer(t.device, "sector table", kSectorTableSide * kSectorTableSide * 4)));
        LOAM_TRY(assign(eye.params, storage_buffer(t.device, "texture params", sizeof(shared::VtParams))));
    }
    LOAM_TRY(
        assign(t.direct_params, storage_buffer(t.device, "direct params", sizeof(shared::DirectParams))));
    LOAM_TRY(t.make_direct_places());
    LOAM_TRY(assign(t.linear, gpu::Sampler::create(t.device, {})));
    LOAM_TRY(assign(t.nearest, gpu::Sampler::create(t.device, {.filter = VK_FILTER_NEAREST})));
    LOAM_TRY(assign(t.fill_pipeline,
                    gpu::Pipeline::create(t.device, gpu::ComputeDesc{.name = "indirection",
                                                                     .shader = "texture/indirection.comp",
                                                                     .bindings = {gpu::storage_image(0),
                                                                                  gpu::storage_buffer(1)},
                                                                     .constants = {}})));
    return assign(t.feedback_pipeline,
                  gpu::Pipeline::create(
                      t.device, gpu::ComputeDesc{.name = "feedback",
                                                 .shader = "texture/feedback.comp",
                                                 .bindings = {gpu::storage_buffer(0), gpu::storage_buffer(1),
                                                              gpu::sampled_image(2), gpu::sampled_image(3),
                                                              gpu::storage_buffer(4), gpu::storage_buffer(5),
                                                              gpu::sampled_image(6)},
                                                 .push_bytes = sizeof(shared::FeedbackPush),
                                                 .constants = {}}));
}

Status VirtualTexture::Impl::make_direct_places() {
    const uint64_t bytes = uint64_t(layers.count) * sizeof(shared::LayerPlace);
    if (direct_places && direct_places.size_bytes() >= bytes) return {};
    return assign(direct_places, storage_buffer(device, "direct places", bytes));
}

Result<std::unique_ptr<VirtualTexture>> VirtualTexture::create(gpu::Device& device, const Document& document,
                                                               IndexMap& index, LayerSet& layers,
                                                               const VirtualTextureDesc& asked) {
    VirtualTextureDesc desc = asked;
    if (desc.pages_per_side < 2 || desc.pages_per_side > 64)
        return error("the physical texture is 2 to 64 pages wide, not {}", desc.pages_per_side);
    if (!std::has_single_bit(uint32_t(desc.indirection_size)) || desc.indirection_size > kMaxIndirectionSize)
        return error("the indirection texture's side is a power of two up to {}, not {}", kMaxIndirectionSize,
                     desc.indirection_size);
    if (is_compressed(desc.format) && !device.caps().bc) desc.format = PageFormat::rgba8;
    auto textures = page_textures(desc.format, document.settings().channels);
    if (!textures.ok()) return textures.error();
    const TextureLayout layout = texture_layout(document.bounds());
    const int log2_size = std::countr_zero(uint32_t(desc.indirection_size));
    if (log2_size < layout.default_log2_width)
        return error("an indirection texture of {} texels cannot hold the map's image of {} pages",
                     desc.indirection_size, 1 << layout.default_log2_width);
    // Their roots stay resident.
    desc.max_live_sectors =
        std::min({desc.max_live_sectors, 255, desc.pages_per_side * desc.pages_per_side / kRootDivisor});
    std::unique_ptr<VirtualTexture> texture(new VirtualTexture);
    texture->impl_ = std::make_unique<Impl>(
        device, document, index, layers, desc, *textures, layout,
        SectorSetDesc{
            .layout = layout, .indirection_log2_size = log2_size, .max_live = desc.max_live_sectors});
    LOAM_TRY(texture->impl_->make_resources());
    auto composer =
        Composer::create(device, document, index, layers, layout, texture->impl_->textures, desc.decals);
    if (!composer.ok()) return composer.error();
    texture->impl_->composer = std::move(*composer);
    return texture;
}

void VirtualTexture::Impl::cmd_indirection(gpu::FrameRing& ring, gpu::Commands& commands) {
    std::vector<shared::IndirectionFill> fills;
    const int size = desc.indirection_size;
    sectors.default_tree().take_fills({0, 0}, size, fills);
    for (LiveSector& sector : sectors.live()) sector.tree->take_fills(sector.origin, size, fills);
    if (fills.empty()) return;
    changed_frame = frame;
    // One workgroup a fill: big squares are cut so that none is much longer than the others.
    constexpr int kLargest = 32;
    std::vector<shared::IndirectionFill> cut;
    for (const auto& f : fills)
        for (int y = 0; y < f.size; y += kLargest)
            for (int x = 0; x < f.size; x += kLargest)
                cut.push_back({f.x + x, f.y + y, std::min(f.size, kLargest), f.value});
    const uint64_t bytes = cut.size() * sizeof(shared::IndirectionFill);
    const gpu::UploadSlice slice = ring.upload(bytes);
    std::memcpy(slice.data, cut.data(), bytes);
    auto pass = commands.pass("texture indirection", {{indirection, Access::compute_storage}});
    commands.bind(fill_pipeline, {{0, indirection.mip_view(0)}, {1, *slice.buffer, slice.offset, bytes}});
    constexpr size_t kMaxGroups = 65535;
    LOAM_CHECK(cut.size() <= kMaxGroups, "more indirection squares than one dispatch takes");
    commands.dispatch(uint32_t(cut.size()));
}

void VirtualTexture::Impl::cmd_eye(gpu::Commands& commands, const TextureView& view, EyeState& eye,
                                   const glm::dvec3& at_m) {
    const SectorPosition at = sector_position({at_m.x, at_m.y});
    const auto log2_texel = [&](const PageId& page) { return float(std::log2(layout.texel_m(page))); };
    shared::VtParams p{};
    p.camera_sector = at.sector;
    p.camera_offset_m = at.offset_m;
    p.table_origin = at.sector - kSectorTableSide / 2;
    p.default_log2_width = layout.default_log2_width;
    p.indirection_size = desc.indirection_size;
    p.inv_atlas_pages = 1.0f / float(desc.pages_per_side);
    p.mip_bias = view.mip_bias;
    p.frame = uint32_t(frame);
    p.default_pages_per_sector = std::ldexp(1.0f, -layout.default_log2_page);
    p.default_log2_texel = log2_texel({{}, layout.default_log2_width, 0, 0});
    p.sector_log2_root = log2_texel({{true, 0, 0}, 0, 0, 0});
    p.short_share = view.filter.short_share;
    p.log2_taps = view.filter.log2_taps;
    commands.use({{eye.params, Access::copy_target}});
    vkCmdUpdateBuffer(commands.handle(), eye.params.handle(), 0, sizeof p, &p);

    if (!eye.table_changed && at.sector == eye.table_sector) return;
    if (eye.table_changed && &eye == &eyes[0]) changed_frame = frame;
    eye.table_changed = false;
    eye.table_sector = at.sector;
    std::vector<uint32_t> table(size_t(kSectorTableSide) * kSectorTableSide);
    sectors.write_table(at.sector, table);
    commands.use({{eye.sector_table, Access::copy_target}});
    vkCmdUpdateBuffer(commands.handle(), eye.sector_table.handle(), 0, table.size() * sizeof table[0],
                      table.data());
}

// What shading without the cache reads.
void VirtualTexture::Impl::cmd_direct(gpu::Commands& commands, const TextureView& view) {
    const SectorPosition camera = sector_position({view.camera_m.x, view.camera_m.y});
    const VirtualMap& map = index.map();
    shared::DirectParams d{};
    d.camera_sector = camera.sector;
    d.camera_offset_m = camera.offset_m;
    d.texels_per_m = float(1.0 / map.spacing_m(0));
    d.texels_per_sector = int(std::lround(kSectorSize_m / map.spacing_m(0)));
    d.level_count = std::min(map.desc().level_count, kMaxIndexLevels);
    d.last_layer = uint32_t(layers.count - 1);
    const GroundSettings& ground = layers.ground;
    if (ground.distortion_amplitude_m > 0) {
        const auto phase = [&](int sector) {
            const double repeats = sector * kSectorSize_m / ground.distortion_period_m;
            return float(repeats - std::floor(repeats));
        };
        d.distortion_origin = {phase(camera.sector.x), phase(camera.sector.y)};
        d.distortion_scale = float(1 / ground.distortion_period_m);
        d.distortion_reach = float(ground.distortion_amplitude_m / map.spacing_m(0));
        d.distortion_lod_bias = float(std::log2(kDistortionTexels / ground.distortion_period_m));
    }
    d.vista_log2_begin = float(far_log2_begin(ground.vista_distance_m));
    d.imagery_log2_begin = float(far_log2_begin(layers.imagery.distance_m));
    d.imagery_strength = float(layers.imagery.strength);
    for (int level = 0; level < d.level_count; ++level)
        d.levels[level] = {int(map.level_offset(level)), map.pages_x(level), map.pages_y(level), 0};
    std::vector<shared::LayerPlace> places;
    for (int layer = 0; layer < layers.count; ++layer) {
        places.push_back(
            Composer::layer_place(camera.sector.x * kSectorSize_m, camera.sector.y * kSectorSize_m, 1.0, 1.0,
                                  layers.tiles_m[size_t(layer)], layers.size_texels, ground.vista_scale));
        layers.fill_place(layer, layers.direct_tier(), places.back());
    }
    commands.use({{direct_params, Access::copy_target}, {direct_places, Access::copy_target}});
    vkCmdUpdateBuffer(commands.handle(), direct_params.handle(), 0, sizeof d, &d);
    vkCmdUpdateBuffer(commands.handle(), direct_places.handle(), 0, places.size() * sizeof places[0],
                      places.data());
}

Status VirtualTexture::take_settings() {
    LOAM_TRY(impl_->composer->take_settings());
    LOAM_TRY(impl_->make_direct_places());
    constexpr double kEverywhere_m = 1.0e6;
    const WorldRect everywhere{-kEverywhere_m, -kEverywhere_m, kEverywhere_m, kEverywhere_m};
    on_dirt({&everywhere, 1}, INFINITY);
    return {};
}

Status VirtualTexture::update(gpu::FrameRing& ring, gpu::Commands& commands, const TextureView& view) {
    Impl& t = *impl_;
    if (!t.advanced) t.advance(view);
    t.advanced = false;
    const std::vector<ComposeJob> jobs = t.choose_jobs(view);
    if (!jobs.empty()) t.changed_frame = t.frame;
    LOAM_TRY(t.composer->cmd_compose(ring, commands, jobs, t.atlas));
    t.cmd_indirection(ring, commands);
    t.cmd_eye(commands, view, t.eye_state(Eye::camera), view.camera_m);
    if (view.announced_m) t.cmd_eye(commands, view, t.eye_state(Eye::announced), *view.announced_m);
    t.cmd_direct(commands, view);
    // From the first frame on everything can be sampled, also before anything was written.
    for (gpu::Image& image : t.atlas) commands.use({{image, Access::fragment_sampled}});
    commands.use({{t.indirection, Access::fragment_sampled}});
#ifndef NDEBUG
    const std::string fault = tree_fault();
    LOAM_CHECK(fault.empty(), fault);
#endif
    return {};
}

Status VirtualTexture::record_feedback(gpu::FrameRing& ring, gpu::Commands& commands,
                                       const FeedbackSource& source) {
    Impl& t = *impl_;
    Impl::EyeState& eye = t.eye_state(source.eye);
    const bool exact = t.still && source.eye == Eye::camera;
    const FeedbackGrid grid =
        feedback_grid(exact ? FeedbackCells::every_pixel : t.desc.feedback_cells, source.picture_px, t.frame);
    const uint64_t bytes = uint64_t(grid.cells.x) * uint64_t(grid.cells.y) * 4;
    if (source.eye == Eye::camera) t.counted.feedback_cells = uint32_t(bytes / 4);
    if (!eye.feedback || eye.feedback.size_bytes() < bytes)
        LOAM_TRY(assign(eye.feedback, storage_buffer(t.device, "feedback", bytes)));
    {
        auto pass = commands.pass("texture feedback", {{source.depth, Access::depth_sampled},
                                                       {source.gbuffer, Access::compute_sampled},
                                                       {eye.params, Access::compute_sampled},
                                                       {eye.sector_table, Access::compute_sampled},
                                                       {t.indirection, Access::compute_sampled},
                                                       {eye.feedback, Access::compute_storage}});
        const VkImageView depth_view =
            source.depth.depth_view() ? source.depth.depth_view() : source.depth.view();
        commands.bind(t.feedback_pipeline,
                      {{0, eye.params},
                       {1, eye.sector_table},
                       {2, depth_view, t.nearest, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL},
                       {3, source.gbuffer.view(), t.nearest},
                       {4, source.uniforms, source.uniforms_offset, VK_WHOLE_SIZE},
                       {5, eye.feedback},
                       {6, t.indirection.view(), t.nearest}});
        commands.push(t.feedback_pipeline,
                      shared::FeedbackPush{grid.cells, grid.jitter, source.footprint_log2});
        commands.dispatch(uint32_t(grid.cells.x + 7) / 8, uint32_t(grid.cells.y + 7) / 8);
    }
    commands.use({{t.indirection, Access::fragment_sampled}});
    ring.read_back(commands, eye.feedback, 0, bytes,
                   [inbox = eye.inbox, images = t.sectors.images(), frame = t.frame,
                    view_frame = t.view_frame, exact](std::span<const std::byte> got) {
                       inbox->values.resize(got.size() / 4);
                       std::memcpy(inbox->values.data(), got.data(), got.size());
                       inbox->images = images;
                       inbox->frame = frame;
                       inbox->view_frame = view_frame;
                       inbox->exact = exact;
                       inbox->fresh = true;
                   });
    return {};
}

gpu::Image& VirtualTexture::atlas(int which) {
    return impl_->atlas[std::min(size_t(which), impl_->atlas.size() - 1)];
}
const PageTextures& VirtualTexture::textures() const {
    return impl_->textures;
}
gpu::Image& VirtualTexture::indirection() {
    return impl_->indirection;
}
gpu::Buffer& VirtualTexture::sector_table() {
    return impl_->eye_state(Eye::camera).sector_table;
}
gpu::Buffer& VirtualTexture::params() {
    return impl_->eye_state(Eye::camera).params;
}
gpu::Buffer& VirtualTexture::direct_params() {
    return impl_->direct_params;
}
gpu::Buffer& VirtualTexture::direct_places() {
    return impl_->direct_places;
}
const gpu::Sampler& VirtualTexture::sampler() const {
    return impl_->linear;
}
const gpu::Sampler& VirtualTexture::nearest_sampler() const {
    return impl_->nearest;
}
const TextureLayout& VirtualTexture::layout() const {
    return impl_->layout;
}
const VirtualTextureDesc& VirtualTexture::desc() const {
    return impl_->desc;
}
uint64_t VirtualTexture::last_feedback_frame() const {
    return impl_->feedback_view_frame;
}

bool VirtualTexture::settled() const {
    const Impl& t = *impl_;
    const bool kept = !t.still || t.kept_since == t.same_since;
    return t.frame > 0 && t.missing.empty() && !t.has_dirt() && t.low_res_count() == 0 && kept &&
           t.feedback_frame >= t.changed_frame && !t.camera_eye().inbox->fresh;
}

int VirtualTexture::place_of(const PageId& page) const {
    const int place = impl_->pool.find(page);
    return place >= 0 && impl_->pool.place(place).state == PagePool::State::usable ? place : -1;
}

VirtualTexture::Statistics VirtualTexture::statistics() const {
    const Impl& t = *impl_;
    Statistics s = t.counted;
    s.resident_pages = uint32_t(t.pool.used_count());
    s.capacity_pages = uint32_t(t.pool.place_count());
    s.live_sectors = uint32_t(t.sectors.live().size());
    s.requested_pages = uint32_t(t.camera_eye().requests.size());
    s.missing_pages = uint32_t(t.missing.size());
    s.dirty_pages = uint32_t(t.dirty.size());
    s.low_res_pages = t.low_res_count();
    s.announced_missing = t.announced_missing;
    s.hidden_pages = t.hidden_pages;
    s.page_ms = t.price.page_ms();
    s.indirection_texels = uint64_t(t.sectors.used_texels());
    s.indirection_capacity = uint64_t(t.sectors.capacity_texels());
    s.capped_images = uint32_t(t.sectors.capped_count());
    s.image_cap_log2 = t.sectors.cap_log2();
    s.indirection_repacks = t.sectors.repack_count();
    s.sharpness = t.sharpness;
    s.gpu_bytes = t.indirection.bytes() + t.composer->gpu_bytes();
    for (const Impl::EyeState& eye : t.eyes)
        s.gpu_bytes += eye.sector_table.size_bytes() + (eye.feedback ? eye.feedback.size_bytes() : 0);
    for (const gpu::Image& image : t.atlas) s.gpu_bytes += image.bytes();
    return s;
}

std::vector<uint32_t> VirtualTexture::expected_indirection() const {
    const Impl& t = *impl_;
    const int size = t.desc.indirection_size, width = size * 3 / 2;
    std::vector<uint32_t> texels(size_t(width) * size_t(size), kUnusedIndirection);
    const auto write = [&](const PageTree& tree, glm::ivec2 origin) {
        for (int level = 0; level <= tree.log2_width(); ++level) {
            const int depth = tree.log2_width() - level;
            const glm::ivec2 at = shared::vt_level_origin(level, size) + (origin >> level);
            for (int y = 0; y < 1 << depth; ++y)
                for (int x = 0; x < 1 << depth; ++x)
                    texels[size_t(at.y + y) * size_t(width) + size_t(at.x + x)] = tree.shown(depth, x, y);
        }
    };
    write(t.sectors.default_tree(), {0, 0});
    for (const LiveSector& sector : t.sectors.live()) write(*sector.tree, sector.origin);
    return texels;
}

}  // namespace loam
