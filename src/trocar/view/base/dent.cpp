#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/dent.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {
namespace {

constexpr double kDentEdge = 0.0016;   // [m] how softly the skin bends round an instrument
constexpr double kDentSkirt = 0.0006;  // [m] how far the skin around a touching one sinks ...
constexpr double kDentReach = 0.0055;  // [m] ... and how wide

}  // namespace

bool near(const tissue::Box& box, std::span<const collision::Capsule> rods) {
  return std::any_of(rods.begin(), rods.end(), [&box](const collision::Capsule& rod) {
    return box.near_segment(rod.a, rod.b, rod.radius + 2 * kDentReach);
  });
}

bool dent(std::span<const collision::Capsule> rods, std::span<Vec3f> positions, std::span<const Vec3f> normals) {
  bool dented = false;
  for (const collision::Capsule& rod : rods) {
    struct Close {
      std::size_t vertex;
      double gap;
      Vec3d away;
    };
    std::vector<Close> close;
    double nearest = 1;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3d p = vec_cast<double>(positions[i]), n = vec_cast<double>(normals[i]);
      const Vec3d from = p - nearest_on_axis(rod, p);
      const double gap = length(from) - rod.radius;
      if (gap > 3 * kDentReach) continue;
      const Vec3d away = normalised(from, -n);
      close.push_back({i, gap, dot(away, n) < 0 ? away : -n});
      nearest = std::min(nearest, gap);
    }
    const double touch = smooth(0.0012, 0.0002, nearest);
    for (const Close& c : close) {
      const double into = kDentEdge - c.gap;
      const double give = into <= 0 ? 0 : (into < 2 * kDentEdge ? into * into / (4 * kDentEdge) : -c.gap);
      const double skirt = touch * kDentSkirt * std::exp(-std::max(0.0, c.gap) / kDentReach);
      positions[c.vertex] += vec_cast<float>(give * c.away) - float(skirt) * normals[c.vertex];
    }
    dented = dented || !close.empty();
  }
  return dented;
}

}  // namespace trocar::view
