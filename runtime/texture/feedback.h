// What the feedback buffer asks for: a pure function of its values and of what is visible now.
// Source: Call of Duty talk, "Processing of the Feedback Buffer": count unique values, add children to
// parents, sort by popularity, bias roots, bias against fine pages by the camera's speed, threshold with
// rescue of visible pages, at most a third of the cache. "Feedback Buffer": its size.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "runtime/texture/page_id.h"

namespace loam {

// Which pixels a frame's feedback looks at.
enum class FeedbackCells {
    grid,         // 240 x 136, another pixel of each cell a frame (the talk's)
    eighth,       // an eighth of the picture's width and height, all 64 pixels of a cell in 64 frames
    every_pixel,  // up to kEveryPixelLimit cells, always the same: a still picture's wishes depend on nothing
                  // but the view
};
inline constexpr int kEveryPixelLimit = 1 << 20;
struct FeedbackGrid {
    glm::ivec2 cells{0};
    glm::vec2 jitter{0.5f};  // in a cell
};
[[nodiscard]] FeedbackGrid feedback_grid(FeedbackCells cells, glm::ivec2 picture_px, uint64_t frame);

// What sector ids meant in the frame that wrote the values.
struct FeedbackImages {
    std::array<ImageId, 256> image{};  // by id; [0] is the default image
    std::array<int8_t, 256> log2_width{};
    std::array<bool, 256> valid{};
};

struct PageRequest {
    PageId page;
    uint32_t popularity = 0;  // cells of the feedback buffer that want the page or something below it, biased
    uint32_t cells = 0;       // that want this very page
};

// The rules' numbers. The talk gives the third; the others were tuned on the example map at 240 x 136.
struct FeedbackRules {
    double threshold_share =
        3.0 / (240 * 136);       // fewer cells than this do not get a page, unless it is visible
    double horizon_s = 0.25;     // a page that the camera crosses faster than this counts for less
    uint32_t cache_divisor = 3;  // at most this part of the cache is requested, but for a still picture
};

struct FeedbackInput {
    std::span<const uint32_t> values;
    const FeedbackImages* images = nullptr;
    TextureLayout layout;
    uint32_t capacity_pages = 0;
    uint32_t kept_pages = 0;  // of them for others: roots of images, hidden sectors, places that rest
    FeedbackRules rules;
    double speed_m_s = 0;                           // of the camera
    // Values of every_pixel: no cell is noise, so no threshold; nothing else will be wanted, so that all
    // pages but the kept ones may be requested.
    bool exact = false;
    std::function<bool(const PageId&)> is_visible;  // usable now: rescued from the threshold
};

struct FeedbackResult {
    std::vector<PageRequest> requests;  // most popular first; a parent always before its children
    uint32_t terrain_cells = 0;
    // Terrain cells by how many mips the page they show is coarser than the one they want; [7]: or more.
    std::array<uint32_t, 8> coarser{};
};

[[nodiscard]] FeedbackResult analyse_feedback(const FeedbackInput& input);

}  // namespace loam
