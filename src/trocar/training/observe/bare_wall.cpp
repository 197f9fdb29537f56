#include <algorithm>
#include <vector>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/training/observe/bare_wall.hpp>

namespace trocar::training {
namespace {

/// Out of the wall at its nodes, as long as they like; zero where all about a node is torn.
std::vector<Vec3d> out_of_wall(const tissue::MembraneModel& sheet, const std::vector<std::uint8_t>& torn,
                               const std::vector<Vec3d>& x) {
  std::vector<Vec3d> out(x.size());
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    if (torn[t]) continue;
    const auto& [a, b, c] = sheet.triangles[t];
    const Vec3d normal = cross(x[std::size_t(b)] - x[std::size_t(a)], x[std::size_t(c)] - x[std::size_t(a)]);
    for (const int n : {a, b, c}) out[std::size_t(n)] += normal;
  }
  return out;
}

/// How much else is about the way that the jaws close on: lobules, and strands' elements.
int crowd_about(const sim::Model& model, const sim::State& state, Vec3d a, Vec3d b) {
  constexpr double kRoom = 0.004;  // [m] between open jaws, to each side
  const auto beside = [&](Vec3d p) { return length(p - a - geometry::closest_on_segment(p, a, b) * (b - a)) < kRoom; };
  int crowd = 0;
  const std::vector<interactions::FatBody>& fats = model.fat;
  for (std::size_t i = 0; i < fats.size(); ++i) {
    const tissue::FatState& fat = state.fat[i];
    for (int n = 0; n < fats[i].fat.lobules(); ++n)
      crowd += !fat.lobules[std::size_t(n)].gone() && beside(position(fats[i].fat, fat, n));
  }
  for (const auto& strand : state.strands) crowd += int(std::count_if(strand.x.begin(), strand.x.end(), beside));
  return crowd;
}

}  // namespace

int wall_to_take(const sim::Model& model, const sim::State& state, int membrane, const Approach& approach,
                 std::span<const int> missed) {
  constexpr double kReach = 0.018, kApart = 0.003, kBefore = 0.006;  // [m]
  constexpr double kEach = 0.003;  // [m] so much further off it is as good without one thing more about it
  constexpr double kFaces = 0.3;   // of the way in, along the normal: more would come from behind
  const tissue::MembraneModel& sheet = model.membranes[std::size_t(membrane)].sheet;
  std::vector<Vec3d> x(sheet.network.rest.size());
  for (std::size_t n = 0; n < x.size(); ++n)
    x[n] = tissue::position(sheet.network, state.membranes[std::size_t(membrane)].network, int(n));
  const std::vector<Vec3d> out = out_of_wall(sheet, state.torn[std::size_t(membrane)], x);
  int best = -1;
  double least = 1e9;
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double off = length(x[n] - approach.place);
    const Vec3d along = normalised(x[n] - approach.from);
    if (off > kReach || length(out[n]) <= 0 || dot(normalised(out[n]), along) > kFaces) continue;
    const auto near = [&](int other) { return length(x[std::size_t(other)] - x[n]) < kApart; };
    if (std::any_of(missed.begin(), missed.end(), near)) continue;
    const double cost = off + kEach * crowd_about(model, state, x[n] - kBefore * along, x[n] + approach.deep * along);
    if (cost < least) least = cost, best = int(n);
  }
  return best;
}

}  // namespace trocar::training
