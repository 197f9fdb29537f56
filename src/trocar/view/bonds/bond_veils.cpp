#include <algorithm>
#include <cmath>

#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/bonds/bond_veils.hpp>

namespace trocar::view {
namespace {

constexpr int kVeilColumns = 8, kVeilRows = 7;       // of vertices: from bond to bond, and from foot to wall
constexpr double kVeilReach = 0.016;                 // [m] bonds further apart have no film between them
constexpr double kVeilSunk = 0.0007;                 // [m] how deep its borders go into what it hangs between
constexpr double kVeilRipple = 0.10;                 // of its height, to the side
constexpr double kVeilDense = 0.75, kThinned = 0.6;  // of Paint's openness; share that a bond loses before it parts
// Of the way to a parted bond: how far a film reaches in the middle and at its ends.
constexpr double kNarrowest = 0.16, kWidest = 0.5;
constexpr double kVeilHighest = 0.02;  // [m] for its ripples
constexpr double kArch = 0.22;    // of the way from bond to bond: how far its border on an organ bows out between them
constexpr double kLaciest = 0.3;  // of what it is elsewhere: where it is thinnest
constexpr double kHem = 0.0016;   // [m] what is left on either side
constexpr double kCord = 0.16;    // of the way to the neighbour: a bond's own, denser tissue

double from_middle2(double v) { return (2 * v - 1) * (2 * v - 1); }

/// How far a film reaches whose border is free: least half-way between its ends. Ragged.
double free_border(int number, int row, double v) {
  const double ragged = 0.7 + 0.6 * varied(number * kVeilRows + row, 11);
  return ragged * (kNarrowest + (kWidest - kNarrowest) * from_middle2(v));
}

/// Its border lies on the organ as an arch from bond to bond, lost in its surface; in between it ripples.
Vec3d film_place(int number, const VeilTie& a, const VeilTie& b, double u, double v, bool spans) {
  const Vec3d rise = a.node - a.foot, across = b.foot - a.foot;
  const Vec3d along = normalised(spans ? rise + (b.node - b.foot) : rise, Vec3d{0, 0, 1});
  const Vec3d side = normalised(cross(along, across), any_perpendicular(along));
  const double arch = kArch * 4 * u * (1 - u) * length(across);
  const Vec3d foot = a.foot + u * across - (kVeilSunk + arch) * along;
  const Vec3d node = a.node + u * (b.node - a.node) + kVeilSunk * along;
  const double swing = std::sin(portable::two_pi * (1.3 * u + 0.7 * v + varied(number, 12))) +
                       0.6 * std::sin(portable::two_pi * (2.9 * u - 0.4 * v + varied(number, 13)));
  const double ripple = kVeilRipple * std::min(length(rise), kVeilHighest) * (1 - from_middle2(v)) * swing;
  return foot + v * (node - foot) + ripple * side;
}

}  // namespace

std::vector<std::pair<int, int>> neighbours(const std::vector<Vec3d>& places, double reach) {
  std::vector<std::pair<int, int>> pairs;
  const auto between = [&](std::size_t i, std::size_t j) {
    return std::any_of(places.begin(), places.end(), [&](const Vec3d& p) {
      return &p != &places[i] && &p != &places[j] && dot(places[i] - p, places[j] - p) < 0;
    });
  };
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size(); ++j)
      if (length(places[i] - places[j]) < reach && !between(i, j)) pairs.push_back({int(i), int(j)});
  return pairs;
}

std::size_t BondVeils::vertices() { return std::size_t(kVeilColumns) * kVeilRows; }

BondVeils::BondVeils(const sim::Model& model, std::size_t set, render::Backend& backend)
    : m_model(&model), m_set(&model.bonds[set]), m_index(set) {
  const sim::State drawn = sim::initial_state(model);
  gather(drawn);
  std::vector<Vec3d> middle;
  for (const VeilTie& tie : m_ties) middle.push_back(0.5 * (tie.foot + tie.node));
  m_pairs = neighbours(middle, kVeilReach);
  if (!any()) return;
  for (std::size_t pair = 0; pair < m_pairs.size(); ++pair) {
    const std::uint32_t first = m_buffer.size();
    for (std::size_t v = 0; v < vertices(); ++v) m_buffer.add({});
    for (std::uint32_t r = 0; r + 1 < kVeilRows; ++r)
      join_rows(m_buffer, first + r * kVeilColumns, first + (r + 1) * kVeilColumns, kVeilColumns, false);
    lay(pair);
  }
  m_buffer.rest = m_buffer.positions;
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

/// @return has any of it changed since it was drawn?
bool BondVeils::gather(const sim::State& state) {
  const interactions::Bodies bodies = sim::bodies_of(*m_model, state);
  m_ties.resize(m_set->bonds.size());
  m_ends.clear();
  bool harmed = false;
  for (std::size_t i = 0; i < m_ties.size(); ++i) {
    const interactions::Bond& bond = m_set->bonds[i];
    VeilTie& tie = m_ties[i];
    tie.foot = root_of(bodies, bond);
    tie.node = place_of(bodies, bond.near);
    const double whole = 1 - std::clamp(double(state.bonds[m_index][i].damage), 0.0, 1.0);
    harmed = harmed || whole != tie.whole;
    tie.whole = whole;
    m_ends.push_back(tie.foot), m_ends.push_back(tie.node);
  }
  return m_moved(m_ends) || harmed;
}

void BondVeils::update(const sim::State& state) {
  if (!any() || !gather(state)) return;
  for (std::size_t pair = 0; pair < m_pairs.size(); ++pair) lay(pair);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  m_mesh.repaint(m_buffer.positions, m_buffer.normals, m_buffer.paint);
}

void BondVeils::lay(std::size_t pair) {
  const VeilTie &a = m_ties[std::size_t(m_pairs[pair].first)], &b = m_ties[std::size_t(m_pairs[pair].second)];
  if (a.whole > 0 && b.whole > 0)
    lay_film(pair, a, b, true);
  else if (a.whole > 0)
    lay_film(pair, a, b, false);
  else if (b.whole > 0)
    lay_film(pair, b, a, false);
  else
    lay_hems(pair, a, b);
}

/// @param dense  0: nothing to be seen @param cord  0..1: how much of a cord
void BondVeils::put(std::size_t pair, int column, int row, Vec3d place, double dense, double cord) {
  const std::size_t v = pair * vertices() + std::size_t(row * kVeilColumns + column);
  m_buffer.positions[v] = vec_cast<float>(place);
  m_buffer.paint[v] = {to_byte(dense), 0, 0, to_byte(cord)};
}

/// From a bond that holds. @param spans  all the way to b; else b has parted, and the border is free
void BondVeils::lay_film(std::size_t pair, const VeilTie& a, const VeilTie& b, bool spans) {
  const int number = int(pair);
  for (int c = 0; c < kVeilColumns; ++c)
    for (int r = 0; r < kVeilRows; ++r) {
      const double share = double(c) / (kVeilColumns - 1), v = double(r) / (kVeilRows - 1);
      const double u = share * (spans ? 1 : free_border(number, r, v));
      const double thin = 1 - kThinned * (1 - (a.whole + u * (b.whole - a.whole)));
      const double frayed = spans ? 1 : 1 - smooth(0.35, 1, share);
      const double there = thin * frayed * smooth(0, 0.25, v) * (r + 1 < kVeilRows ? 1 : 0.6);
      const double lacy = kLaciest + (1 - kLaciest) * varied(number * 97 + r * kVeilColumns + c, 14);
      const double cord = 0.5 * smooth(kCord, 0, spans ? std::min(u, 1 - u) : u);
      put(pair, c, r, film_place(number, a, b, u, v, spans), kVeilDense * lacy * there, cord * there);
    }
}

/// What is left where nothing hangs any more: between this pair on the organ or on the wall. A strip that had both
/// would go all the way between them, wherever the wall is carried.
void BondVeils::lay_hems(std::size_t pair, const VeilTie& a, const VeilTie& b) {
  const bool on_organ = varied(int(pair), 20) < 0.5;
  for (int c = 0; c < kVeilColumns; ++c) {
    const double u = double(c) / (kVeilColumns - 1);
    const Vec3d foot = a.foot + u * (b.foot - a.foot), node = a.node + u * (b.node - a.node);
    const Vec3d way = node - foot, along = normalised(way, Vec3d{0, 0, 1});
    const double hem = std::min(kHem * (0.3 + 1.2 * varied(int(pair) * kVeilColumns + c, 21)), 0.4 * length(way));
    for (int r = 0; r < kVeilRows; ++r) {
      const double share = double(r) / (kVeilRows - 1);
      const Vec3d off = (share * hem - (1 - share) * kVeilSunk) * along;
      put(pair, c, r, on_organ ? foot + off : node - off, kVeilDense * (1 - share), 0.4 * (1 - share));
    }
  }
}

}  // namespace trocar::view
