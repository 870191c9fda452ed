#include "runtime/frame/debug_views.h"

#include "runtime/base/check.h"
#include "shaders/frame/debug_io.h"

namespace loam {

namespace {

constexpr DebugViewInfo kViews[] = {
    {DebugView::none, "none", "Final picture", ""},
    {DebugView::mips, "mips", "Shown mip", "mip of the page shown in its virtual image, 0 is the finest",
     DebugScale::steps},
    {DebugView::sectors, "sectors", "Sectors",
     "a colour a live sector; one for all that the default sector shows"},
    {DebugView::normals, "normals", "Normals", "red east, green north, blue up"},
    {DebugView::occlusion, "occlusion", "Ambient occlusion", "white is open sky"},
    {DebugView::indirection, "indirection", "Indirection",
     "the indirection texel's 32 bits as a colour: a colour a physical page"},
    {DebugView::shadow, "shadow", "Shadow", "white is in the sun"},
    {DebugView::albedo, "albedo", "Albedo", ""},
    {DebugView::wanted, "wanted", "Wanted mip", "mip that the pixel would like in its virtual image",
     DebugScale::steps},
    {DebugView::coarser, "coarser", "Missing mips", "mips between what is wanted and what is shown",
     DebugScale::steps},
    {DebugView::age, "age", "Page age", "frames since the page shown was last requested", DebugScale::frames},
    {DebugView::requests, "requests", "Requests",
     "cells of the feedback that ask for the page shown; grey: none", DebugScale::cells},
    {DebugView::dirt, "dirt", "Dirt", "red: edited and not yet composed; fading since the last edit",
     DebugScale::dirt},
    {DebugView::cost, "cost", "Composition cost",
     "texels composed into the page shown lately, in whole pages", DebugScale::pages},
    {DebugView::decals, "decals", "Decals a page", "decals over the page shown; grey: none",
     DebugScale::decals},
    {DebugView::heights, "heights", "Height pages", "level of the height page under a pixel, 0 is the finest",
     DebugScale::steps},
    {DebugView::atlas, "atlas", "Physical texture",
     "left albedo, right normal and gloss over metalness and occlusion; green frame: wanted, dim: resting, "
     "red frame: edited"},
    {DebugView::indirection_map, "indirection-map", "Indirection texture",
     "the whole texture, a colour a physical page; white rims: images of sectors"},
    {DebugView::thermal, "thermal", "Heat", "the map's thermal channel: violet is cool, white is hot"},
};
static_assert(std::size(kViews) == size_t(DebugView::count));
static_assert(uint32_t(DebugView::wanted) == kDebugWanted && uint32_t(DebugView::decals) == kDebugDecals &&
              uint32_t(DebugView::albedo) == kDebugAlbedo &&
              uint32_t(DebugView::indirection_map) == kDebugIndirectionMap &&
              uint32_t(DebugView::thermal) == kDebugThermal);

}  // namespace

std::span<const DebugViewInfo> debug_views() {
    return kViews;
}

const DebugViewInfo& debug_view_info(DebugView view) {
    const DebugViewInfo& info = kViews[size_t(view)];
    LOAM_CHECK(info.view == view, "the table of debug views is not in order");
    return info;
}

bool debug_is_map(DebugView view) {
    return view == DebugView::atlas || view == DebugView::indirection_map;
}

}  // namespace loam
