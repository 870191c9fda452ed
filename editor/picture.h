// Arithmetic on pictures: averages in linear light, and how far one picture is from another.
#pragma once

#include <vector>

#include "editor/session.h"

namespace loam {

// Mean of pictures of one size, in linear light.
class LinearAverage {
  public:
    void add(const Picture& picture);
    [[nodiscard]] Picture picture() const;

  private:
    int width_ = 0, height_ = 0, count_ = 0;
    std::vector<float> sum_;  // RGB a pixel
};

// Peak signal-to-noise ratio of the sRGB-encoded RGB channels in dB; equal pictures give infinity. Sizes must
// agree.
[[nodiscard]] double psnr_db(const Picture& a, const Picture& b);
// Mean square of the Laplacian of the luma (4-neighbour stencil, borders left out): the energy of fine
// detail.
[[nodiscard]] double laplacian_energy(const Picture& picture);
// Share of pixels of which any channel differs by more than `tolerance`.
[[nodiscard]] double differing_share(const Picture& a, const Picture& b, int tolerance);

// How far one picture is from another as the eye sees a change: mean absolute difference of a channel over
// the 8 x 8 pixels where it is largest, and the difference that 99.9 % of the pixels' largest channels do not
// exceed. 0 … 255; sizes must agree.
struct PictureStep {
    double tile = 0, pixel = 0;
};
[[nodiscard]] PictureStep picture_step(const Picture& a, const Picture& b);

}  // namespace loam
