#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {
namespace {

constexpr std::size_t kSlices = 16;
constexpr double kBandHalf = 0.0028;                          // [m] half the width of a gut's band
constexpr float kPatternAlong = 1.12f, kPatternRound = 0.9f;  // how fine a gut's patterns are

/// Longest extent of the body: the direction along which a gut is divided into bulges.
Vec3d long_axis(const tissue::Skin& skin) {
  Vec3d mean{}, axis{1, 1, 1};
  for (const Vec3f& p : skin.rest) mean += vec_cast<double>(p) / double(skin.rest.size());
  for (int i = 0; i < 12; ++i) {  // power iteration on the scatter matrix
    Vec3d next{};
    for (const Vec3f& p : skin.rest) {
      const Vec3d d = vec_cast<double>(p) - mean;
      next += dot(d, axis) * d;
    }
    axis = normalised(next);
  }
  return axis;
}

void add_follicles(const Relief& relief, const tissue::Skin& skin, std::vector<float>& height,
                   std::vector<Paint>& paint) {
  std::vector<Vec3f> centres;
  const int seed = int(std::fabs(skin.rest.front().x) * 1e6f) % 9973 + (skin.rest.front().x < 0 ? 10007 : 0);
  for (int k = 0; k < 40 * relief.follicles && int(centres.size()) < relief.follicles; ++k) {
    const std::size_t v = std::size_t(varied(seed + k, 71) * double(skin.rest.size() - 1));
    const double radius = relief.follicle_radius * (0.45 + 0.55 * varied(seed + k, 72));
    const auto close = [&](Vec3f c) { return length(c - skin.rest[v]) < float(1.5 * relief.follicle_radius); };
    if (std::any_of(centres.begin(), centres.end(), close)) continue;
    centres.push_back(skin.rest[v]);
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      const double d = double(length(skin.rest[i] - skin.rest[v])) / radius;
      if (d >= 1) continue;
      const double dome = (1 - d * d) * (1 - 0.35 * d * d);
      height[i] += float(0.38 * radius * dome);
      paint[i].tint = std::max(paint[i].tint, to_byte(0.7 * smooth(1, 0.3, d)));
    }
  }
}

/// One of the two that an ovary of that age may have, on the side that faces upwards: a thin-walled blister, or a
/// corpus luteum with its dimple, through which the egg left.
void add_ripe(const Relief& relief, const tissue::Skin& skin, std::vector<float>& height, std::vector<Paint>& paint) {
  const bool luteum = skin.rest.front().x < 0;
  std::size_t centre = 0;
  double best = -1;
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    const Vec3f n = skin.rest_normal[i];
    const double faces = 0.6 * double(n.z) + 0.5 * double(n.y) + 0.5 * varied(int(i), luteum ? 78 : 79);
    if (faces <= best) continue;
    best = faces;
    centre = i;
  }
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    const double d = double(length(skin.rest[i] - skin.rest[centre])) / relief.ripe;
    if (luteum)  // the whole ovary is duskier for it, here and there
      paint[i].tint =
          std::max(paint[i].tint, to_byte(0.45 * smooth(-0.3, 0.5, waves(vec_cast<double>(skin.rest[i]), 0.021))));
    if (d >= 1) continue;
    const double dome = (1 - d * d) * (1 - 0.3 * d * d);
    height[i] += float(relief.ripe * (0.3 * dome - (luteum ? 0.16 * smooth(0.35, 0, d) : 0)));
    paint[i].tint = std::max(paint[i].tint, to_byte((luteum ? 0.7 : 0.9) * smooth(1, 0.4, d)));
    paint[i].openness = std::uint8_t(paint[i].openness * (1 - 0.22 * smooth(1, 0.8, d) * smooth(0.5, 0.8, d)));
  }
}

/// No organ is its mold's: full here, flat there, over its whole size.
void add_lopsided(const Relief& relief, const tissue::Skin& skin, std::vector<float>& height) {
  const double own = 0.013 * double(skin.rest.size() % 17) + (skin.rest.front().x < 0 ? 0.05 : 0);
  for (std::size_t i = 0; i < height.size(); ++i) {
    const Vec3d p = vec_cast<double>(skin.rest[i]);
    height[i] += float(relief.lopsided * waves(p + Vec3d{own, 0.7 * own, 0}, 4.5 * relief.broad_size));
  }
}

/// Scars of an ovary: short furrows, each in a direction of its own.
void add_scars(const Relief& relief, const tissue::Skin& skin, std::vector<float>& height) {
  const int seed = int(std::fabs(skin.rest.front().y) * 1e6f) % 9973 + (skin.rest.front().x < 0 ? 20011 : 0);
  for (int k = 0; k < relief.scars; ++k) {
    const std::size_t v = std::size_t(varied(seed + k, 75) * double(skin.rest.size() - 1));
    const Vec3d n = vec_cast<double>(skin.rest_normal[v]), x = any_perpendicular(n), y = cross(n, x);
    const double turn = portable::two_pi * varied(seed + k, 76), half = 0.0022 * (0.4 + varied(seed + k, 77));
    const Vec3d along = std::cos(turn) * x + std::sin(turn) * y;
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      const Vec3d d = vec_cast<double>(skin.rest[i] - skin.rest[v]);
      const double on = std::clamp(dot(d, along), -half, half), far = length(d - on * along);
      height[i] -= float(0.00045 * smooth(0.0019, 0, far));
    }
  }
}

/// Large gut: three flat pale bands of muscle run along it; between them the wall bulges and is drawn in crosswise, in
/// each third at places of its own.
void add_haustra(const Relief& relief, const tissue::Skin& skin, std::vector<float>& height,
                 std::vector<Paint>& paint) {
  const Vec3d axis = long_axis(skin);
  double low = 1e9, high = -1e9;
  for (const Vec3f& p : skin.rest) {
    low = std::min(low, dot(vec_cast<double>(p), axis));
    high = std::max(high, dot(vec_cast<double>(p), axis));
  }
  // The middle line, as means of slices.
  const double slice = (high - low) / kSlices;
  std::vector<Vec3d> middle(kSlices + 1);
  std::vector<double> count(kSlices + 1, 0.0);
  for (const Vec3f& q : skin.rest) {
    const Vec3d p = vec_cast<double>(q);
    const double at = (dot(p, axis) - low) / slice;
    for (std::size_t k = 0; k <= kSlices; ++k) {
      const double share = std::max(0.0, 1.2 - std::fabs(at - double(k)));
      middle[k] += share * p;
      count[k] += share;
    }
  }
  for (std::size_t k = 0; k <= kSlices; ++k) middle[k] = (1 / std::max(count[k], 1e-9)) * middle[k];
  const Vec3d right = any_perpendicular(axis), up = cross(axis, right);
  for (std::size_t i = 0; i < height.size(); ++i) {
    const Vec3d p = vec_cast<double>(skin.rest[i]);
    const double at = std::clamp((dot(p, axis) - low) / slice, 0.0, double(kSlices) - 1e-6);
    const auto k = std::size_t(at);
    const Vec3d from = p - (middle[k] + (at - double(k)) * (middle[k + 1] - middle[k]));
    const double turn = std::atan2(dot(from, up), dot(from, right)) / portable::two_pi + 0.5;  // 0..1
    const double third = 3 * turn + 0.12 * waves(p, 0.05), away = std::fabs(third - std::round(third)) / 3;
    const double band = smooth(kBandHalf + 0.0022, kBandHalf - 0.0006, away * portable::two_pi * length(from));
    const double along =
        dot(p, axis) / relief.haustra_size + 0.37 * std::floor(third) + 0.3 * waves(p, 2.5 * relief.haustra_size);
    const double furrow = std::pow(0.5 + 0.5 * std::cos(portable::two_pi * along), 5);
    height[i] -= float(relief.haustra * (furrow * (1 - band) + 0.15 * band));
    paint[i].tint = std::max(paint[i].tint, to_byte(0.8 * band));
    paint[i].openness = std::uint8_t(paint[i].openness * (1 - 0.3 * furrow * (1 - band)));
  }
}

/// A cone with rounded flanks around each root.
void add_roots(const Relief& relief, const tissue::Skin& skin, std::vector<float>& height) {
  for (const Relief::Root& root : relief.roots)
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      const double d = length(vec_cast<double>(skin.rest[i]) - root.at) / (4.5 * root.radius);
      if (d < 1) height[i] += float(0.8 * root.radius * (1 - d) * (1 - d) * (1 + d));
    }
}

}  // namespace

double waves(Vec3d p, double size) {
  const Vec3d q = (portable::two_pi / size) * p;
  const double a = std::sin(q.x + 1.3 * std::sin(0.71 * q.y + 0.5)) * std::cos(0.83 * q.y + 0.9 * std::sin(0.64 * q.z));
  const double b = std::sin(0.77 * q.z + 1.1 * std::cos(0.59 * q.x + 1.7) + 0.3 * q.y);
  return 0.6 * a + 0.4 * b;
}

std::vector<Vec3f> pattern_coordinates(const Relief& relief, const tissue::Skin& skin) {
  std::vector<Vec3f> rest = skin.rest;
  if (relief.haustra <= 0) return rest;
  const Vec3f axis = vec_cast<float>(long_axis(skin));
  for (Vec3f& p : rest) p = kPatternRound * p + ((kPatternAlong - kPatternRound) * dot(p, axis)) * axis;
  return rest;
}

std::vector<float> heights(const Relief& relief, const tissue::Skin& skin, std::vector<Paint>& paint) {
  std::vector<float> height(skin.rest.size(), 0.0f);
  for (std::size_t i = 0; i < height.size(); ++i) {
    const Vec3d p = vec_cast<double>(skin.rest[i]);
    height[i] = float(relief.broad * waves(p, relief.broad_size) +
                      relief.fine * waves(p + Vec3d{0.1, 0.2, 0.3}, relief.fine_size));
  }
  if (relief.haustra > 0) add_haustra(relief, skin, height, paint);
  if (relief.follicles > 0) add_follicles(relief, skin, height, paint);
  if (relief.scars > 0) add_scars(relief, skin, height);
  if (relief.ripe > 0) add_ripe(relief, skin, height, paint);
  if (relief.lopsided > 0) add_lopsided(relief, skin, height);
  add_roots(relief, skin, height);
  return height;
}

}  // namespace trocar::view
