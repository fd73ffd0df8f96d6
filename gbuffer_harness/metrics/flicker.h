// Changes between two frames that should look alike.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "metrics/masked_image.h"
#include "metrics/spots.h"
#include "metrics/surface.h"
#include "reference/camera_motion.h"

namespace pellucid::harness {

// Each of three channels, of a difference d between the frames.
struct Flicker {
  std::array<double, 3> relativeRmse = {};  // RMS of d over the RMS of the still frame
  // Statistics of |d| over the mean of the still frame's 5x5 pixels around it that show a surface with
  // material, at least kDarkestPart of the RMS: what 99.9 % of the pixels are at or below (nearest rank), and
  // the largest.
  std::array<double, 3> p999 = {}, worst = {};
  std::array<int, 2> worstPixel = {0, 0};  // x, y in the still frame, of the largest of all channels
  std::size_t pixels = 0;                  // that were compared; 0: all is 0
};

// `moved` shows at (x + shiftX, y + shiftY) what `still` shows at (x, y), pixels; d is what is left of the
// difference. Pixels that do not count, or whose place in `moved` is outside of it or not finite, are left
// out. Throws InputError when the images are not of one size with three channels.
Flicker compareShifted(const Image& still, const Image& moved, const Mask& mask, int shiftX, int shiftY);

// Two frames of one camera whose lights turned a little: d is the difference less its mean over the 5x5
// pixels around it, since diffused light changes evenly along a surface. Pixels whose 5x5 surroundings are
// not wholly of surface, or do not all count, are left out; edges of hard shadows that move are not. Throws
// likewise.
Flicker compareTurned(const Image& still, const Image& turned, const Surfaces& surfaces, const Mask& mask);

// Two frames of a path, each by a camera of its own: the pixels of the later frame in the earlier one. Both
// captures outlive it.
class Reprojection {
public:
  // Throws InputError for an oblique or singular projection.
  Reprojection(const Capture& earlier, const Capture& later);

  // Capture::motion of the later capture, where bodies stand still in the world.
  Image motion() const { return motion_.image(); }

  // d is the difference between the later frame's image and the earlier image at the same place of the
  // surface, read between pixels, less its mean over the 5x5 pixels around it, since diffused light changes
  // evenly. Left out are places that the earlier frame does not show, and pixels whose surroundings of 5x5
  // pixels, or of 2x2 in the earlier frame, are not wholly of one surface. Statistics are over the later
  // frame. Throws InputError when an image has not its capture's size with three channels.
  Flicker compare(const Image& earlier, const Image& later) const;

private:
  std::optional<std::array<double, 3>> read(const Image& image, int x, int y) const;

  const Capture &earlier_, &later_;
  Surfaces earlierSurfaces_, laterSurfaces_;
  reference::CameraMotion motion_;
};

// The frames of a path in their order, each beside the frame before.
class PathFlicker {
public:
  using Render = std::function<std::vector<Image>(const Capture&)>;

  // Gives the capture its motion, renders its images, and compares each with the image of the frame before.
  // `switches`: a light goes on or off before this frame. Empty for the first frame and where lights switch.
  std::vector<Flicker> next(Capture capture, bool switches, const Render& render);

private:
  std::optional<Capture> last_;
  std::vector<Image> images_;
};

// The flicker of a path: the mean of its steps' RMSE, and the largest of each other statistic.
Flicker flickerOf(const std::vector<Flicker>& steps);

// Spots of two frames of turned lights (metrics/spots.h). `stillInput`, `turnedInput`: what explains each
// frame's.
struct SpotFlicker {
  std::size_t still = 0, turned = 0;  // that the frame has
  std::size_t appear = 0,
              vanish = 0;  // of `turned` that the still frame lacks; of `still` that the turned one lacks
};
SpotFlicker compareSpots(const SpotImage& still, const SpotImage& stillInput, const SpotImage& turned,
                         const SpotImage& turnedInput);

}  // namespace pellucid::harness
