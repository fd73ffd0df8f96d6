// The demonstration scene: a thin ear in front of a head, lit from behind.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "scene/field.h"
#include "scene/model.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// A curve over the xy plane that carries two more quantities along (z, w).
class Spline {
public:
  // A closed spline wraps around; an open one runs from the first to the last control point.
  Spline(const std::vector<glm::dvec4>& controls, bool closed);

  struct Nearest {
    glm::dvec4 value;  // of the curve there
    double distance;   // in the xy plane
    glm::dvec2 away;   // unit, from the curve to the point
    bool left;         // whether the point is to the left of the direction of travel
  };
  Nearest nearest(const glm::dvec2& point) const;

  // A lower bound on nearest(point).distance, from the circle around the curve.
  double atLeast(const glm::dvec2& point) const { return glm::distance(point, center_) - radius_; }

private:
  // a + b u + c u^2 + d u^3 for u in 0 .. 1.
  struct Segment {
    glm::dvec4 a, b, c, d;
  };
  // The segment that holds parameter t, and t's fraction in it. Parameters are whole numbers at the
  // segments' ends; t is at most one turn outside a closed curve.
  const Segment& segmentAt(double t, double& u) const {
    const auto length = static_cast<double>(segments_.size());
    if (closed_) {
      if (t < 0) t += length;
      if (t >= length) t -= length;
    } else {
      t = std::clamp(t, 0.0, length);
    }
    const auto index = std::min(static_cast<std::size_t>(t), segments_.size() - 1);
    u = t - static_cast<double>(index);
    return segments_[index];
  }

  std::vector<Segment> segments_;
  bool closed_;
  std::vector<glm::dvec2> samples_;
  glm::dvec2 center_;
  double radius_;
};

constexpr int kSamplesPerSegment = 4;

Spline::Spline(const std::vector<glm::dvec4>& controls, bool closed) : closed_(closed) {
  std::vector<glm::dvec4> p = controls;
  if (closed) {
    p.insert(p.end(), controls.begin(), controls.begin() + 3);
  } else {
    // Reflected end points make the curve begin and end at the outermost given ones.
    p.insert(p.begin(), 2.0 * controls[0] - controls[1]);
    p.push_back(2.0 * p.back() - p[p.size() - 2]);
  }
  for (std::size_t i = 0; i + 3 < p.size(); ++i) {
    segments_.push_back({(p[i] + 4.0 * p[i + 1] + p[i + 2]) / 6.0, (p[i + 2] - p[i]) / 2.0,
                         (p[i] - 2.0 * p[i + 1] + p[i + 2]) / 2.0,
                         (p[i + 3] - p[i] + 3.0 * (p[i + 1] - p[i + 2])) / 6.0});
  }
  const int count = static_cast<int>(segments_.size()) * kSamplesPerSegment + (closed ? 0 : 1);
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (int i = 0; i < count; ++i) {
    double u;
    const Segment& s = segmentAt(static_cast<double>(i) / kSamplesPerSegment, u);
    samples_.emplace_back(s.a + u * (s.b + u * (s.c + u * s.d)));
  }
  // A B-spline stays inside the hull of its control points.
  for (const glm::dvec4& control : p) {
    low = glm::min(low, glm::dvec2(control));
    high = glm::max(high, glm::dvec2(control));
  }
  center_ = (low + high) / 2.0;
  radius_ = glm::distance(low, high) / 2;
}

Spline::Nearest Spline::nearest(const glm::dvec2& point) const {
  std::size_t best = 0;
  double bestSquare = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const double dx = samples_[i].x - point.x;
    const double dy = samples_[i].y - point.y;
    const double square = dx * dx + dy * dy;
    if (square < bestSquare) {
      bestSquare = square;
      best = i;
    }
  }
  // Newton on the derivative of the squared distance, kept between the neighboring samples.
  constexpr double kReach = 1.0 / kSamplesPerSegment;
  const double start = static_cast<double>(best) * kReach;
  double t = start;
  for (int i = 0; i < 5; ++i) {
    double u;
    const Segment& s = segmentAt(t, u);
    const glm::dvec2 b(s.b), c(s.c), d(s.d);
    const glm::dvec2 apart = glm::dvec2(s.a) + u * (b + u * (c + u * d)) - point;
    const glm::dvec2 first = b + u * (2.0 * c + u * 3.0 * d);
    const glm::dvec2 second = 2.0 * c + u * 6.0 * d;
    const double slope = glm::dot(first, first) + glm::dot(apart, second);
    // Inside a bend the distance has no minimum nearby; the Gauss-Newton step still descends.
    const double step = glm::dot(apart, first) / (slope > 0 ? slope : glm::dot(first, first));
    t = std::clamp(t - step, start - kReach, start + kReach);
    // Convergence is quadratic: the next step would be of the order of the square.
    if (std::abs(step) < 1e-6) break;
  }
  double u;
  const Segment& s = segmentAt(t, u);
  const glm::dvec4 value = s.a + u * (s.b + u * (s.c + u * s.d));
  const glm::dvec2 tangent(s.b + u * (2.0 * s.c + u * 3.0 * s.d));
  const glm::dvec2 away = point - glm::dvec2(value);
  const double distance = glm::length(away);
  return {value, distance, distance > 0 ? away / distance : glm::dvec2(0, 1),
          tangent.x * away.y - tangent.y * away.x > 0};
}

// A value over the xy plane with its gradient.
struct Height {
  double value = 0;
  glm::dvec2 slope = glm::dvec2(0);

  void add(double amount, const glm::dvec2& gradient) {
    value += amount;
    slope += gradient;
  }
};

struct HeadShape {
  glm::dvec3 center, radii;
};
constexpr HeadShape kHead = {{67.6, 12, -72}, {80, 112, 90}};

// A left auricle in mm: x towards the face, y up, z away from the head. A sheet of cartilage folded
// into bowl and ridges, a tube (the helix) along its rim, and the bumps in front of the ear canal.
class Ear : public DistanceField {
public:
  Ear()
      : DistanceField(glm::dvec3(-27, -42, -24), glm::dvec3(36, 40, 14), 2e-3),
        // x, y, z and tube radius, counterclockwise seen from outside.
        rim_({{13, 9, -4, 1.8},
              {15.5, 17, -0.5, 2.4},
              {13, 26, 3, 2.8},
              {4, 32.5, 5, 3.1},
              {-9, 31.5, 6, 3.2},
              {-18, 22.5, 6.5, 3.2},
              {-21, 9, 6.5, 3.0},
              {-19, -3, 6, 2.7},
              {-15, -14, 5, 2.3},
              {-11.5, -22, 3.5, 2},
              {-9, -29, 2, 1.9},
              {-3, -35, 1, 1.9},
              {5, -35.5, 0, 1.9},
              {10, -29, -2, 1.9},
              {14, -20, -4, 1.8},
              {17, -8, -6, 1.8}},
             true),
        // x, y, height and reach; both level out at the ends, where a slope would leave a crease.
        antihelix_({{0, -18, 3, 6.5},
                    {-3, -17, 3, 6.5},
                    {-7.5, -13, 4.6, 6.8},
                    {-10, -5, 5.4, 7},
                    {-10, 4, 5.4, 7.2},
                    {-7, 12, 4.6, 7.5},
                    {-3, 20, 1, 8},
                    {-2, 24, 1, 8}},
                   false),
        lowerCrus_({{-9, 5, 1, 6},
                    {-6.5, 8.5, 1, 6},
                    {-2, 12, 3.6, 6},
                    {5, 14.5, 3.6, 6},
                    {10, 15.5, 2, 6},
                    {13, 16, 2, 6}},
                   false),
        // x, y, z and tube radius.
        helixRoot_({{15, 9, -3, 2.8}, {11, 4, -4.5, 2.8}, {6, 0.5, -7, 2.6}, {0, -1.5, -9.5, 2}}, false) {}

  double distance(const glm::dvec3& p) const override {
    const glm::dvec2 xy(p);
    const Spline::Nearest rim = rim_.nearest(xy);
    const double inside = rim.left ? rim.distance : -rim.distance;

    const Height middle = sheetHeight(xy, rim, inside);
    const double halfThickness = sheetThickness(xy) / 2;
    const double across = std::abs(p.z - middle.value) / std::sqrt(1 + glm::dot(middle.slope, middle.slope));
    const double sheet = smoothIntersection(across - halfThickness, -inside - 0.3, 2.0);
    double d = smoothUnion(sheet, tube(rim, p.z), 2.0);

    // Farther away than the rounding reaches, a part changes nothing.
    if (helixRoot_.atLeast(xy) - 3 < d + 3) d = smoothUnion(d, tube(helixRoot_.nearest(xy), p.z), 3);
    const double antitragus = ellipsoidDistance(p - glm::dvec3(3, -20.5, 0.5), {6, 3.6, 3.6});
    const double tragus = ellipsoidDistance(p - glm::dvec3(16, -8, -2.5), {4.5, 7, 5.5});
    d = smoothUnion(d, antitragus, 4);
    d = smoothUnion(d, tragus, 5);
    d = smoothUnion(d, ellipsoidDistance(p - kHead.center, kHead.radii), 6);
    // The folds bend the field, so far from the surface it promises less than it says.
    return d < 1 ? 0.8 * d : 0.8 + 0.5 * (d - 1);
  }

private:
  static double tube(const Spline::Nearest& near, double z) {
    return std::hypot(near.distance, z - near.value.z) - near.value.w;
  }

  Height sheetHeight(const glm::dvec2& xy, const Spline::Nearest& rim, double inside) const {
    Height height;
    // Up to the back of the helix along the rim.
    addFold(height, rim.value.z - 1.2, inside > 0 ? inside : 0, 8.5, rim.away);

    // The concha: a bowl with steep walls.
    const glm::dmat2 toBowl(0.96 / 14, 0.28 / 18.5, -0.28 / 14, 0.96 / 18.5);
    const glm::dvec2 bowl = toBowl * (xy - glm::dvec2(5.5, -4.5));
    const double q = glm::dot(bowl, bowl);
    if (q < 1) {
      const double depth = -11.5;
      const double s = 1 - q;
      height.add(depth * s * s * s * (s * (6 * s - 15) + 10),
                 -60 * depth * square(s * q) * (glm::transpose(toBowl) * bowl));
    }
    addRidge(height, antihelix_, xy);
    addRidge(height, lowerCrus_, xy);
    return height;
  }

  // A smooth fold of the given height where distance is 0 that ends at `reach`.
  static void addFold(Height& height, double amount, double distance, double reach, const glm::dvec2& away) {
    const double s = 1 - square(distance / reach);
    if (s > 0) height.add(amount * s * s * s, away * (-6 * amount * s * s * distance / square(reach)));
  }

  // A fold along a spline that carries its height (z) and reach (w, at most kLongestReach).
  static void addRidge(Height& height, const Spline& spline, const glm::dvec2& xy) {
    constexpr double kLongestReach = 8;
    if (spline.atLeast(xy) > kLongestReach) return;
    const Spline::Nearest near = spline.nearest(xy);
    addFold(height, near.value.z, near.distance, near.value.w, near.away);
  }

  static double sheetThickness(const glm::dvec2& xy) {
    const glm::dvec2 fromLobe = (xy - glm::dvec2(-0.5, -29)) / glm::dvec2(10, 9);
    return 2.4 + 3.0 * std::exp(-glm::dot(fromLobe, fromLobe));
  }

  Spline rim_, antihelix_, lowerCrus_, helixRoot_;
};

SceneModel buildEar(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model;
  model.camera = placeCamera(parameters, {{-40, 10, 380}, {3, -2, 0}, options["extent"], false, 200, 700});
  model.objects.emplace_back().solid = std::make_unique<Ear>();
  model.objects.emplace_back().solid = std::make_unique<Ellipsoid>(kHead.center, kHead.radii);
  model.center = {10, 0, -30};
  model.radius = 90;

  LightPlacement back{glm::dvec3(-5, 0, 0), {-0.55, 0.3, -0.78}, options["backLight"]};
  back.type = PELLUCID_LIGHT_POINT;
  back.distance = 500;
  back.coneRadius = 90;
  LightPlacement front{glm::dvec3(0), {-0.75, 0.55, 0.36}, options["frontLight"]};
  front.distance = 500;
  front.coneRadius = 90;
  model.lights = {placeLight(parameters, back), placeLight(parameters, front)};
  model.albedo = skinAlbedo;
  return model;
}

}  // namespace

std::vector<SceneDefinition> earScenes() {
  return {{{"ear",
            "Thin ear in front of a head, strong light from behind, weak light from the side",
            {{"backLight", 4, 0, 1e6, "irradiance of the light behind the head, at the ear"},
             {"frontLight", 0.7, 0, 1e6, "irradiance of the light from the front"},
             {"extent", 92, 1, 1e4, "visible width, mm"}}},
           buildEar}};
}

}  // namespace pellucid::harness
