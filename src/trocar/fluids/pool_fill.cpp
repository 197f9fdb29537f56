#include <algorithm>
#include <queue>
#include <vector>

#include <trocar/fluids/pool_fill.hpp>

namespace trocar::fluids {
namespace {

struct Cell {
  float height = 0;
  int i = 0, j = 0;
  bool operator>(const Cell& other) const { return height > other.height; }
};

/// Cells in the order in which rising fluid reaches them, from the lowest on: each the lowest beside those before it.
class Rising {
 public:
  Rising(const PoolModel& m, std::span<const float> floor)
      : m_model(m), m_floor(floor), m_met(std::size_t(m.nx) * std::size_t(m.ny)) {
    Cell lowest{floor_at(m, floor, 0, 0), 0, 0};
    for (int j = 0; j < m.ny; ++j)
      for (int i = 0; i < m.nx; ++i)
        if (floor_at(m, floor, i, j) < lowest.height) lowest = {floor_at(m, floor, i, j), i, j};
    meet(lowest.i, lowest.j);
  }
  bool none() const { return m_border.empty(); }
  float next_height() const { return m_border.top().height; }
  Cell take() {
    const Cell c = m_border.top();
    m_border.pop();
    for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) meet(c.i + di, c.j + dj);
    return c;
  }
  bool at_rim(const Cell& c) const { return c.i == 0 || c.j == 0 || c.i + 1 == m_model.nx || c.j + 1 == m_model.ny; }

 private:
  void meet(int i, int j) {
    if (i < 0 || j < 0 || i >= m_model.nx || j >= m_model.ny) return;
    char& met = m_met[std::size_t(j) * std::size_t(m_model.nx) + std::size_t(i)];
    if (met) return;
    met = 1;
    m_border.push({floor_at(m_model, m_floor, i, j), i, j});
  }

  const PoolModel& m_model;
  std::span<const float> m_floor;
  std::vector<char> m_met;
  std::priority_queue<Cell, std::vector<Cell>, std::greater<>> m_border;
};

}  // namespace

Mix fill_level(const PoolModel& m, std::span<const float> floor, const Mix& mix, PoolState& s) {
  const double whole = double(mix.total()), per_metre = 1.0 / double(m.height_per_pl);
  std::vector<Cell> under;
  double level = -1e9, room = 0;  // [m] [pL]
  bool rim = false;
  for (Rising rising(m, floor); !rising.none() && !rim;) {
    // The surface lies no lower than where it has been: what is behind a ridge fills to the ridge.
    const double next = std::max(level, double(rising.next_height()));
    const double more = double(under.size()) * (next - level) * per_metre;
    if (!under.empty() && room + more >= whole) break;
    room += under.empty() ? 0 : more;
    level = next;
    under.push_back(rising.take());
    room += (level - double(under.back().height)) * per_metre;
    if (room >= whole) break;
    rim = rising.at_rim(under.back());
  }
  if (room < whole && !rim) level += (whole - room) / per_metre / double(under.size());
  Mix left = mix;
  for (const Cell& c : under) {
    const double depth = std::max(0.0, level - double(c.height));
    const Mix in = share(left, std::int64_t(depth * per_metre));
    if (pour(m, c.i, c.j, in, s)) left -= in;
  }
  if (!rim && left.total() > 0 && left.total() <= std::int64_t(under.size()) &&
      pour(m, under[0].i, under[0].j, left, s))
    left = {};  // what rounding left over
  return mix - left;
}

}  // namespace trocar::fluids
