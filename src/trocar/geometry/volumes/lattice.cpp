// Inside or outside is asked along columns: each triangle is drawn once over a grid of rays that run along the third
// axis, and leaves there the height at which the ray passes it and whether it enters or leaves. Which of two neighbours
// a ray meets on their common edge follows from exactly opposite signs, so a closed mesh is never leaky.
//
// How far along the body a point inside is follows from the ray's way in and its way out: between the two it changes
// evenly. Points of one cell whose ways differ too much are of two loops and make two cells; a corner at which cells of
// several loops meet is a node for each.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/volumes/lattice.hpp>

namespace trocar::geometry {
namespace {

// Shifts the rays off the positions that designed shapes prefer (any small irrational would do).
constexpr double kJitterX = 0.00217391, kJitterY = 0.00131718, kJitterZ = 0.00173205;

constexpr double kMostPlaces = 8e6, kMostRays = 16e6;

struct RayCrossing {
  double height;
  int leaves;  // +1: the ray leaves the body here, -1: it enters
  double along;
};
// What a ray passes of the body between going in and coming out.
struct Passage {
  double from, to;              // heights
  double along_from, along_to;  // how far along the body

  double along(double z) const { return along_from + (along_to - along_from) * ((z - from) / (to - from)); }
};

// Twice the signed area of (p, a, b) in the plane of the first two axes; exactly opposite for (p, b, a).
double twice_area_xy(Vec3d a, Vec3d b, double x, double y) { return (a.x - x) * (b.y - y) - (a.y - y) * (b.x - x); }
bool to_the_left(double area, Vec3d a, Vec3d b) {
  if (area != 0.0) return area > 0.0;
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

class Columns {
 public:
  Columns(int nx, int ny, int samples) : m_nx(nx * samples), m_ny(ny * samples), m_samples(samples) {
    m_crossings.resize(std::size_t(m_nx) * m_ny);
  }

  using Along = std::array<double, 3>;  // of a triangle's corners

  void draw(Vec3d a, Vec3d b, Vec3d c, const Along& along) {
    const int first_x = std::max(0, index_above(std::min({a.x, b.x, c.x}), kJitterX));
    const int last_x = std::min(m_nx - 1, index_above(std::max({a.x, b.x, c.x}), kJitterX));
    const int first_y = std::max(0, index_above(std::min({a.y, b.y, c.y}), kJitterY));
    const int last_y = std::min(m_ny - 1, index_above(std::max({a.y, b.y, c.y}), kJitterY));
    for (int j = first_y; j <= last_y; ++j)
      for (int i = first_x; i <= last_x; ++i) meet(i, j, a, b, c, along);
  }

  bool inside(int i, int j, double z) const {
    int winding = 0;
    for (const RayCrossing& crossing : m_crossings[i + std::size_t(m_nx) * j])
      if (crossing.height > z) winding += crossing.leaves;
    return winding > 0;
  }

  // Rays that go in and have not come out leave through the wall that is nearest along the body.
  void pair_up() {
    m_passages.resize(m_crossings.size());
    for (std::size_t ray = 0; ray < m_crossings.size(); ++ray) {
      std::vector<RayCrossing>& crossings = m_crossings[ray];
      std::sort(crossings.begin(), crossings.end(), [](const RayCrossing& a, const RayCrossing& b) {
        return a.height != b.height ? a.height < b.height : a.leaves < b.leaves;
      });
      std::vector<RayCrossing> open;
      for (const RayCrossing& crossing : crossings) {
        if (crossing.leaves < 0) {
          open.push_back(crossing);
        } else if (!open.empty()) {
          const auto entry =
              std::min_element(open.begin(), open.end(), [&](const RayCrossing& a, const RayCrossing& b) {
                return std::fabs(a.along - crossing.along) < std::fabs(b.along - crossing.along);
              });
          m_passages[ray].push_back({entry->height, crossing.height, entry->along, crossing.along});
          open.erase(entry);
        }
      }
    }
  }
  // How far along the body a place is, once for each loop that it is in.
  void ways_along(int i, int j, double z, double apart, std::vector<double>& out) const {
    const std::size_t before = out.size();
    for (const Passage& passage : m_passages[i + std::size_t(m_nx) * j]) {
      if (!(passage.from < z && z < passage.to)) continue;
      const double way = passage.along(z);
      if (std::none_of(out.begin() + std::ptrdiff_t(before), out.end(),
                       [&](double other) { return std::fabs(other - way) <= apart; }))
        out.push_back(way);
    }
  }

 private:
  double x_of(int i) const { return (i + 0.5) / m_samples + kJitterX; }
  double y_of(int j) const { return (j + 0.5) / m_samples + kJitterY; }
  // A little early, so that rounding here cannot leave out a ray: meet() decides.
  int index_above(double coordinate, double jitter) const {
    return static_cast<int>(std::floor((coordinate - jitter) * m_samples - 0.5));
  }

  void meet(int i, int j, Vec3d a, Vec3d b, Vec3d c, const Along& along) {
    const double x = x_of(i), y = y_of(j);
    const double wa = twice_area_xy(b, c, x, y), wb = twice_area_xy(c, a, x, y), wc = twice_area_xy(a, b, x, y);
    const bool left = to_the_left(wa, b, c);
    if (left != to_the_left(wb, c, a) || left != to_the_left(wc, a, b)) return;
    const double whole = wa + wb + wc;
    const double height = whole == 0.0 ? (a.z + b.z + c.z) / 3.0 : (wa * a.z + wb * b.z + wc * c.z) / whole;
    const double way = whole == 0.0 ? along[0] : (wa * along[0] + wb * along[1] + wc * along[2]) / whole;
    m_crossings[i + std::size_t(m_nx) * j].push_back({height, left ? 1 : -1, way});
  }

  int m_nx, m_ny, m_samples;
  std::vector<std::vector<RayCrossing>> m_crossings;
  std::vector<std::vector<Passage>> m_passages;
};

Lattice empty_lattice(const TriMesh& mesh, double cell, const Mat3d& frame) {
  Lattice lattice;
  lattice.cell = cell;
  lattice.frame = frame;
  std::vector<Vec3d> turned;
  for (const Vec3d& p : mesh.positions) turned.push_back(transposed(frame) * p);
  const Bounds box = bounds(turned);
  double places = 1.0;
  Vec3d low;
  for (int k = 0; k < 3; ++k) {
    const double cells = std::max(1.0, std::ceil((box.high[k] - box.low[k]) / cell * (1.0 - 1e-12)));
    places *= cells;
    if (!(places <= kMostPlaces))
      throw std::invalid_argument("make_lattice: cell too small for this mesh's box (over 8 million cells)");
    lattice.dims[k] = static_cast<int>(cells);
    low[k] = 0.5 * (box.low[k] + box.high[k]) - 0.5 * cell * cells;
  }
  lattice.origin = frame * low;
  return lattice;
}

double fill_of(const Columns& columns, std::array<int, 3> place, int samples) {
  int count = 0;
  for (int k = 0; k < samples; ++k)
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i)
        count +=
            columns.inside(place[0] * samples + i, place[1] * samples + j, place[2] + (k + 0.5) / samples + kJitterZ);
  return double(count) / (samples * samples * samples);
}

// Points of a cell that belong together: their share of the cell, and between which ways along the body they lie.
struct Loop {
  double fill = 0, low = 0, high = 0;

  double middle() const { return 0.5 * (low + high); }
};

std::vector<Loop> loops_of(const Columns& columns, std::array<int, 3> place, const LatticeOptions& options) {
  const int samples = options.samples;
  std::vector<double> ways;
  for (int k = 0; k < samples; ++k)
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i)
        columns.ways_along(place[0] * samples + i, place[1] * samples + j, place[2] + (k + 0.5) / samples + kJitterZ,
                           options.apart, ways);
  std::sort(ways.begin(), ways.end());
  std::vector<Loop> loops;
  for (const double way : ways) {
    if (loops.empty() || way - loops.back().high > options.apart) loops.push_back({0, way, way});
    loops.back().fill += 1.0 / (samples * samples * samples);
    loops.back().high = way;
  }
  return loops;
}

void number_nodes(Lattice& lattice) {
  const auto& d = lattice.dims;
  const auto index = [&](int i, int j, int k) { return i + std::size_t(d[0] + 1) * (j + std::size_t(d[1] + 1) * k); };
  std::vector<int> number(index(d[0], d[1], d[2]) + 1, -1);
  const auto corner = [](const std::array<int, 3>& p, int c) {
    return std::array<int, 3>{p[0] + (c & 1), p[1] + (c >> 1 & 1), p[2] + (c >> 2 & 1)};
  };
  for (const auto& place : lattice.places)
    for (int c = 0; c < 8; ++c) {
      const auto n = corner(place, c);
      number[index(n[0], n[1], n[2])] = 0;
    }
  for (int k = 0; k <= d[2]; ++k)
    for (int j = 0; j <= d[1]; ++j)
      for (int i = 0; i <= d[0]; ++i) {
        int& n = number[index(i, j, k)];
        if (n < 0) continue;
        n = static_cast<int>(lattice.nodes.size());
        lattice.nodes.push_back(lattice.origin +
                                lattice.frame * (lattice.cell * Vec3d{double(i), double(j), double(k)}));
      }
  for (const auto& place : lattice.places) {
    std::array<int, 8> nodes;
    for (int c = 0; c < 8; ++c) {
      const auto n = corner(place, c);
      nodes[c] = number[index(n[0], n[1], n[2])];
    }
    lattice.cells.push_back(nodes);
  }
}

constexpr int kMostAtCorner = 64;  // cells of a body in loops that meet at one corner; more would lie in one another

// A cell at a corner of the lattice's places, and which of its corners that is.
struct AtCorner {
  int cell, corner;
  Loop loop;
};

// The same where loops come near each other: cells at a corner share a node there where they hang together. False where
// all of them do.
bool number_nodes_by_loops(Lattice& lattice, const std::vector<Loop>& loops) {
  const auto& d = lattice.dims;
  bool several = false;
  lattice.cells.assign(lattice.places.size(), {});
  std::vector<AtCorner> around;
  for (int k = 0; k <= d[2]; ++k)
    for (int j = 0; j <= d[1]; ++j)
      for (int i = 0; i <= d[0]; ++i) {
        around.clear();
        double high = 0;
        for (int c = 0; c < 8; ++c)
          for (int cell = lattice.cell_of(i - (c & 1), j - (c >> 1 & 1), k - (c >> 2 & 1)); cell >= 0;
               cell = lattice.other_of(cell))
            around.push_back({cell, c, loops[cell]});
        if (around.size() > kMostAtCorner)
          throw std::invalid_argument("make_lattice: a body whose loops do not lie in one another expected");
        std::stable_sort(around.begin(), around.end(),
                         [](const AtCorner& a, const AtCorner& b) { return a.loop.low < b.loop.low; });
        for (std::size_t n = 0; n < around.size(); ++n) {
          const AtCorner& at = around[n];
          const bool apart = n > 0 && at.loop.low - high > lattice.apart;
          if (n == 0 || apart)
            lattice.nodes.push_back(lattice.origin +
                                    lattice.frame * (lattice.cell * Vec3d{double(i), double(j), double(k)}));
          several = several || apart;
          high = n == 0 ? at.loop.high : std::max(high, at.loop.high);
          lattice.cells[at.cell][at.corner] = static_cast<int>(lattice.nodes.size()) - 1;
        }
      }
  return several;
}

// Cells, each loop's at a place after the other. False where no loop comes near another: then it is a lattice like any.
bool place_loops(Lattice& lattice, const Columns& columns, const LatticeOptions& options) {
  const auto& d = lattice.dims;
  std::vector<Loop> loops;
  for (int k = 0; k < d[2]; ++k)
    for (int j = 0; j < d[1]; ++j)
      for (int i = 0; i < d[0]; ++i) {
        int last = -1;
        for (const Loop& loop : loops_of(columns, {i, j, k}, options)) {
          if (!(loop.fill > options.least_fill)) continue;
          const int cell = static_cast<int>(lattice.places.size());
          (last < 0 ? lattice.cell_at[i + d[0] * (j + d[1] * k)] : lattice.other_at[last]) = cell;
          last = cell;
          lattice.places.push_back({i, j, k});
          lattice.cell_fill.push_back(std::min(loop.fill, 1.0));
          lattice.cell_along.push_back(loop.middle());
          lattice.other_at.push_back(-1);
          loops.push_back(loop);
        }
      }
  return number_nodes_by_loops(lattice, loops);
}

// Do two cells share a node?
bool hang_together(const Lattice& lattice, int a, int b) {
  for (const int n : lattice.cells[a])
    for (const int m : lattice.cells[b])
      if (n == m) return true;
  return false;
}

}  // namespace

Lattice make_lattice(const TriMesh& closed, double cell, const LatticeOptions& options) {
  if (!(cell > 0.0)) throw std::invalid_argument("make_lattice: a cell above 0 expected");
  if (!check_edges(closed).closed()) throw std::invalid_argument("make_lattice: a closed mesh expected");
  Lattice lattice = empty_lattice(closed, cell, options.frame);
  const auto& d = lattice.dims;

  if (!(double(d[0]) * d[1] * options.samples * options.samples <= kMostRays))
    throw std::invalid_argument("make_lattice: cell too small for this mesh's box (over 16 million rays)");
  Columns columns(d[0], d[1], options.samples);
  const bool in_loops = !options.along.empty();
  if (in_loops && options.along.size() != closed.positions.size())
    throw std::invalid_argument("make_lattice: a way along for each vertex expected");
  std::vector<Vec3d> points;
  for (const Vec3d& p : closed.positions) points.push_back(lattice.in_cells(p));
  const auto along = [&](int v) { return in_loops ? options.along[v] : 0.0; };
  for (const auto& t : closed.triangles)
    columns.draw(points[t[0]], points[t[1]], points[t[2]], {along(t[0]), along(t[1]), along(t[2])});

  lattice.cell_at.assign(std::size_t(d[0]) * d[1] * d[2], -1);
  if (in_loops) {
    Lattice looped = lattice;
    looped.apart = options.apart;
    columns.pair_up();
    if (place_loops(looped, columns, options)) return looped;
  }
  for (int k = 0; k < d[2]; ++k)
    for (int j = 0; j < d[1]; ++j)
      for (int i = 0; i < d[0]; ++i) {
        const double fill = fill_of(columns, {i, j, k}, options.samples);
        if (!(fill > options.least_fill)) continue;
        lattice.cell_at[i + d[0] * (j + d[1] * k)] = static_cast<int>(lattice.places.size());
        lattice.places.push_back({i, j, k});
        lattice.cell_fill.push_back(fill);
      }
  number_nodes(lattice);
  return lattice;
}

int pieces(const Lattice& lattice) {
  std::vector<char> seen(lattice.places.size(), 0);
  std::vector<int> waiting;
  int count = 0;
  for (int start = 0; start < static_cast<int>(lattice.places.size()); ++start) {
    if (seen[start]) continue;
    ++count;
    seen[start] = 1;
    waiting.push_back(start);
    while (!waiting.empty()) {
      const int here = waiting.back();
      const auto place = lattice.places[here];
      waiting.pop_back();
      for (int face = 0; face < 6; ++face) {
        auto next = place;
        next[face / 2] += face % 2 ? 1 : -1;
        for (int cell = lattice.cell_of(next[0], next[1], next[2]); cell >= 0; cell = lattice.other_of(cell)) {
          if (seen[cell] || !hang_together(lattice, here, cell)) continue;
          seen[cell] = 1;
          waiting.push_back(cell);
        }
      }
    }
  }
  return count;
}

}  // namespace trocar::geometry
