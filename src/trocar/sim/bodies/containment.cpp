#include <algorithm>

#include <trocar/sim/bodies/containment.hpp>

namespace trocar::sim {
namespace {

constexpr int kParts = 4;         // of a body, of which one is looked at each tick
constexpr float kReturn = 0.25f;  // in which what is outside comes back [s]
constexpr float kRub = 0.9f;      // share of its speed that it keeps in a tick

/// Are all rows between two places?
bool between(Vec3f low, Vec3f high, std::span<const tissue::NodeState> rows) noexcept {
  float least[4] = {low.x, low.y, low.z, 0}, most[4] = {high.x, high.y, high.z, 0};
  for (const tissue::NodeState& n : rows) {
    const float x[4] = {n.x, n.y, n.z, n.zero0};
    for (int k = 0; k < 4; ++k) least[k] = x[k] < least[k] ? x[k] : least[k];
    for (int k = 0; k < 4; ++k) most[k] = x[k] > most[k] ? x[k] : most[k];
  }
  return least[0] >= low.x && least[1] >= low.y && least[2] >= low.z && most[0] <= high.x && most[1] <= high.y &&
         most[2] <= high.z;
}

/// Speeds only: a node that is moved strains its springs, tick after tick, and a bar that lay at a plane was driven to
/// and fro by that.
/// @return whether it had left
template <class T>
bool turn_back(Vec3<T> low, Vec3<T> high, Vec3<T> x, Vec3<T>& v) noexcept {
  bool left = false;
  for (int k = 0; k < 3; ++k) {
    const T below = low[k] - x[k], above = x[k] - high[k];
    if (below > 0) v[k] = std::max(v[k], below / T(kReturn));
    if (above > 0) v[k] = std::min(v[k], -above / T(kReturn));
    left = left || below > 0 || above > 0;
  }
  if (left) v = T(kRub) * v;
  return left;
}

}  // namespace

// Its skin would not tell: what has been torn leaves nodes by themselves.
void turn_back(const tissue::Box& cavity, std::span<const int> row_of_node, Vec3d origin, std::uint64_t tick,
               std::span<tissue::NodeState> rows) noexcept {
  const Vec3f low = vec_cast<float>(vec_cast<double>(cavity.low) - origin);
  const Vec3f high = vec_cast<float>(vec_cast<double>(cavity.high) - origin);
  const size_t part = size_t(tick % kParts), first = rows.size() * part / kParts;
  if (between(low, high, rows.subspan(first, rows.size() * (part + 1) / kParts - first))) return;
  for (const int row : row_of_node) {
    if (row < 0) continue;
    tissue::NodeState& n = rows[size_t(row)];
    Vec3f v{n.vx, n.vy, n.vz};
    if (!turn_back(low, high, Vec3f{n.x, n.y, n.z}, v)) continue;
    n.vx = v.x, n.vy = v.y, n.vz = v.z;
  }
}

void turn_back(const tissue::Box& cavity, tissue::StrandState& strand) noexcept {
  const Vec3d low = vec_cast<double>(cavity.low), high = vec_cast<double>(cavity.high);
  for (size_t i = 0; i < strand.x.size(); ++i) turn_back(low, high, strand.x[i], strand.v[i]);
}

}  // namespace trocar::sim
