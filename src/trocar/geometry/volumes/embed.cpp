#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/volumes/embed.hpp>

namespace trocar::geometry {
namespace {

struct Nearest {
  int cell = -1;
  double distance2 = 0.0;  // in cells
};

// Distance of q (in cells) from the unit cell at a place.
double distance2_to(Vec3d q, std::array<int, 3> place) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double out = std::max({place[k] - q[k], q[k] - (place[k] + 1.0), 0.0});
    sum += out * out;
  }
  return sum;
}

// Of a point's own loop: how far along the body it is; no matter where that is not known.
struct OfLoop {
  const double* along = nullptr;

  bool has(const Lattice& lattice, int cell) const {
    return !along || lattice.cell_along.empty() || std::fabs(lattice.cell_along[cell] - *along) <= lattice.apart;
  }
};

void look_at(const Lattice& lattice, Vec3d q, std::array<int, 3> place, OfLoop loop, Nearest& best) {
  for (int cell = lattice.cell_of(place[0], place[1], place[2]); cell >= 0; cell = lattice.other_of(cell)) {
    if (!loop.has(lattice, cell)) continue;
    const double d2 = distance2_to(q, place);
    if (best.cell < 0 || d2 < best.distance2 || (d2 == best.distance2 && cell < best.cell)) best = {cell, d2};
  }
}

// Shells of places around the one that is nearest to q, until no further shell can be nearer.
Nearest nearest_cell(const Lattice& lattice, Vec3d q, OfLoop loop) {
  std::array<int, 3> centre;
  for (int k = 0; k < 3; ++k) centre[k] = static_cast<int>(std::floor(std::clamp(q[k], 0.0, lattice.dims[k] - 0.5)));
  Nearest best;
  const int last = std::max({lattice.dims[0], lattice.dims[1], lattice.dims[2]});
  for (int r = 0; r <= last; ++r) {
    // A place r steps away along some axis is at least r - 1 from q along this axis.
    if (best.cell >= 0 && (r - 1.0) * (r - 1.0) > best.distance2 && r > 0) break;
    for (int k = -r; k <= r; ++k)
      for (int j = -r; j <= r; ++j) {
        const bool whole_row = std::abs(k) == r || std::abs(j) == r;
        for (int i = -r; i <= r; i += whole_row || r == 0 ? 1 : 2 * r)
          look_at(lattice, q, {centre[0] + i, centre[1] + j, centre[2] + k}, loop, best);
      }
  }
  return best;
}

}  // namespace

Embedding embed(const Lattice& lattice, std::span<const Vec3d> points, std::span<const double> along) {
  if (lattice.cells.empty()) throw std::invalid_argument("embed: a lattice with cells expected");
  Embedding result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d q = lattice.in_cells(points[i]);
    const Nearest nearest = nearest_cell(lattice, q, {along.empty() ? nullptr : &along[i]});
    if (nearest.cell < 0) throw std::invalid_argument("embed: cells along the whole body expected");
    const auto& place = lattice.places[nearest.cell];
    const double x = q.x - place[0], y = q.y - place[1], z = q.z - place[2];
    std::array<double, 8> weights;
    for (int k = 0; k < 8; ++k) weights[k] = (k & 1 ? x : 1.0 - x) * (k & 2 ? y : 1.0 - y) * (k & 4 ? z : 1.0 - z);
    result.nodes.push_back(lattice.cells[nearest.cell]);
    result.weights.push_back(weights);
    result.cells.push_back(nearest.cell);
    result.farthest = std::max(result.farthest, lattice.cell * std::sqrt(nearest.distance2));
  }
  return result;
}

}  // namespace trocar::geometry
