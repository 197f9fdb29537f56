#include <algorithm>
#include <cmath>

#include <trocar/view/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;

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

/// A cone with rounded flanks around each root.
void add_roots(const Relief& relief, const tissue::Skin& skin, std::vector<float>& height) {
  for (const Relief::Root& root : relief.roots)
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      const double d = length(vec_cast<double>(skin.rest[i]) - root.at) / (3.2 * root.radius);
      if (d < 1) height[i] += float(1.0 * root.radius * (1 - d) * (1 - d));
    }
}

}  // namespace

double waves(Vec3d p, double size) {
  const Vec3d q = (kTwoPi / size) * p;
  const double a = std::sin(q.x + 1.3 * std::sin(0.71 * q.y + 0.5)) * std::cos(0.83 * q.y + 0.9 * std::sin(0.64 * q.z));
  const double b = std::sin(0.77 * q.z + 1.1 * std::cos(0.59 * q.x + 1.7) + 0.3 * q.y);
  return 0.6 * a + 0.4 * b;
}

std::vector<float> heights(const Relief& relief, const tissue::Skin& skin, std::vector<Paint>& paint) {
  std::vector<float> height(skin.rest.size(), 0.0f);
  const Vec3d axis = relief.haustra > 0 ? long_axis(skin) : Vec3d{1, 0, 0};
  for (std::size_t i = 0; i < height.size(); ++i) {
    const Vec3d p = vec_cast<double>(skin.rest[i]);
    double h =
        relief.broad * waves(p, relief.broad_size) + relief.fine * waves(p + Vec3d{0.1, 0.2, 0.3}, relief.fine_size);
    if (relief.haustra > 0) {
      const double along = dot(p, axis) / relief.haustra_size + 0.25 * waves(p, 2 * relief.haustra_size);
      const double furrow = std::pow(0.5 + 0.5 * std::cos(kTwoPi * along), 4);
      h -= relief.haustra * furrow;
      paint[i].tint = std::max(paint[i].tint, to_byte(0.25 * furrow));
    }
    height[i] = float(h);
  }
  if (relief.follicles > 0) add_follicles(relief, skin, height, paint);
  add_roots(relief, skin, height);
  return height;
}

}  // namespace trocar::view
