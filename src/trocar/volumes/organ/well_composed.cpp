#include <trocar/volumes/organ/well_composed.hpp>

namespace trocar::volumes {
namespace {

/// Two of four around an edge, across from each other.
bool crossed(int a, int b, int c, int d) { return a == d && b == c && a != b; }

class Composer {
 public:
  explicit Composer(PaddedVoxels& voxels) : m_voxels(voxels) {
    const std::size_t nx = std::size_t(voxels.size[0]), ny = std::size_t(voxels.size[1]);
    for (std::size_t c = 0; c < 8; ++c) m_corner[c] = (c & 1) + nx * ((c >> 1 & 1) + ny * (c >> 2 & 1));
  }

  std::size_t run() {
    for (int k = 0; k + 1 < m_voxels.size[2]; ++k)
      for (int j = 0; j + 1 < m_voxels.size[1]; ++j)
        for (int i = 0; i + 1 < m_voxels.size[0]; ++i) mend({i, j, k});
    while (!m_again.empty()) {
      const std::array<int, 3> cell = m_again.back();
      m_again.pop_back();
      mend(cell);
    }
    return m_added;
  }

 private:
  PaddedVoxels& m_voxels;
  std::size_t m_corner[8]{};
  std::vector<std::array<int, 3>> m_again;
  std::size_t m_added = 0;

  /// Fills voxels of a cell of 2 x 2 x 2 until it is one sheet.
  void mend(const std::array<int, 3>& cell) {
    for (int fill = to_fill(cell); fill >= 0; fill = to_fill(cell)) {
      const std::array<int, 3> at{cell[0] + (fill & 1), cell[1] + (fill >> 1 & 1), cell[2] + (fill >> 2 & 1)};
      m_voxels.in[m_voxels.index(at[0], at[1], at[2])] = 1;
      ++m_added;
      for (int n = 0; n < 8; ++n) {  // the cells around it
        const std::array<int, 3> near{at[0] - (n & 1), at[1] - (n >> 1 & 1), at[2] - (n >> 2 & 1)};
        bool there = true;
        for (std::size_t a = 0; a < 3; ++a) there = there && near[a] >= 0 && near[a] + 1 < m_voxels.size[a];
        if (there) m_again.push_back(near);
      }
    }
  }

  bool on_border(const std::array<int, 3>& cell, int corner) const {
    for (std::size_t a = 0; a < 3; ++a) {
      const int at = cell[a] + (corner >> a & 1);
      if (at == 0 || at == m_voxels.size[a] - 1) return true;
    }
    return false;
  }

  /// The corner to be filled, or -1.
  int to_fill(const std::array<int, 3>& cell) const {
    const std::uint8_t* first = m_voxels.in.data() + m_voxels.index(cell[0], cell[1], cell[2]);
    int c[8], count = 0;
    for (int n = 0; n < 8; ++n) count += c[n] = first[m_corner[n]];
    if (count < 2 || count > 6) return -1;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
      for (int side = 0; side < 2; ++side) {
        const int base = side << axis;
        if (!crossed(c[base], c[base + u], c[base + v], c[base + u + v])) continue;
        // Of both empty ones the one with more voxels beside it.
        const int a = c[base] != 0 ? base + u : base, b = c[base] != 0 ? base + v : base + u + v;
        if (on_border(cell, a)) return b;
        if (on_border(cell, b)) return a;
        return beside(cell, b) > beside(cell, a) ? b : a;
      }
    }
    for (int n = 0; n < 4; ++n) {
      const bool corners_in = count == 2 && c[n] != 0 && c[7 - n] != 0;
      const bool corners_out = count == 6 && c[n] == 0 && c[7 - n] == 0;
      if (corners_out) return on_border(cell, n) ? 7 - n : n;
      if (corners_in)
        for (int m = 0; m < 8; ++m)
          if (c[m] == 0 && !on_border(cell, m)) return m;
    }
    return -1;
  }
  int beside(const std::array<int, 3>& cell, int corner) const {
    const std::size_t at =
        m_voxels.index(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1));
    int out = 0;
    for (const std::size_t stride : {m_corner[1], m_corner[2], m_corner[4]})
      out += m_voxels.in[at - stride] + m_voxels.in[at + stride];
    return out;
  }
};

}  // namespace

std::size_t make_well_composed(PaddedVoxels& voxels) { return Composer(voxels).run(); }

}  // namespace trocar::volumes
