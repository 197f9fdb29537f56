#include <trocar/suture/thread/block_system.hpp>

namespace trocar::suture {
namespace {

typedef double Four __attribute__((vector_size(32), may_alias));  // a column of a block
static_assert(alignof(Block) >= alignof(Four), "columns are read and written in one move");

inline const Four& column(const Block& b, int c) { return *reinterpret_cast<const Four*>(b.c[c]); }
inline void set_column(Block& b, int c, const Four& a) { *reinterpret_cast<Four*>(b.c[c]) = a; }

// A pivot's block holds L D L^T of it: 1 / d on the diagonal, L below.
struct Pivot {
  double l10, l20, l21, r0, r1, r2;
};
inline bool take_pivot(Block& d, Pivot& p) {
  const double d0 = d.c[0][0];
  p.r0 = 1 / d0;
  p.l10 = d.c[0][1] * p.r0, p.l20 = d.c[0][2] * p.r0;
  const double d1 = d.c[1][1] - p.l10 * d.c[0][1];
  p.r1 = 1 / d1;
  const double a21 = d.c[1][2] - p.l10 * d.c[0][2];
  p.l21 = a21 * p.r1;
  const double d2 = d.c[2][2] - p.l20 * d.c[0][2] - p.l21 * a21;
  p.r2 = 1 / d2;
  d.c[0][0] = p.r0, d.c[1][1] = p.r1, d.c[2][2] = p.r2;
  d.c[0][1] = p.l10, d.c[0][2] = p.l20, d.c[1][2] = p.l21;
  return d0 > 0 && d1 > 0 && d2 > 0;
}
/// A becomes Y = A L^-T.
inline void to_y(Block& a, const Pivot& p) {
  const Four y0 = column(a, 0), y1 = column(a, 1) - p.l10 * y0, y2 = column(a, 2) - p.l20 * y0 - p.l21 * y1;
  set_column(a, 1, y1), set_column(a, 2, y2);
}
/// A -= Yi D^-1 Yj^T
inline void take_off(Block& a, const Block& yi, const Block& yj, const Pivot& p) {
  const Four i0 = p.r0 * column(yi, 0), i1 = p.r1 * column(yi, 1), i2 = p.r2 * column(yi, 2);
  for (int c = 0; c < 3; ++c) set_column(a, c, column(a, c) - i0 * yj.c[0][c] - i1 * yj.c[1][c] - i2 * yj.c[2][c]);
}
/// The transpose of it.
inline Block transposed_block(const Block& a) {
  Block b;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) b.c[c][r] = a.c[r][c];
    b.c[c][3] = 0;
  }
  return b;
}
inline Pivot pivot_of(const Block& d) { return {d.c[0][1], d.c[0][2], d.c[1][2], d.c[0][0], d.c[1][1], d.c[2][2]}; }
/// b becomes z = L^-1 b
inline void down(const Pivot& p, Vec3d& b) {
  b.y -= p.l10 * b.x;
  b.z -= p.l20 * b.x + p.l21 * b.y;
}
/// b -= Y D^-1 z, given D^-1 z
inline void pass_down(const Block& y, Vec3d scaled, Vec3d& b) {
  b.x -= y.c[0][0] * scaled.x + y.c[1][0] * scaled.y + y.c[2][0] * scaled.z;
  b.y -= y.c[0][1] * scaled.x + y.c[1][1] * scaled.y + y.c[2][1] * scaled.z;
  b.z -= y.c[0][2] * scaled.x + y.c[1][2] * scaled.y + y.c[2][2] * scaled.z;
}
/// z -= Y^T x
inline void pass_up(const Block& y, Vec3d x, Vec3d& z) {
  z.x -= y.c[0][0] * x.x + y.c[0][1] * x.y + y.c[0][2] * x.z;
  z.y -= y.c[1][0] * x.x + y.c[1][1] * x.y + y.c[1][2] * x.z;
  z.z -= y.c[2][0] * x.x + y.c[2][1] * x.y + y.c[2][2] * x.z;
}
/// x = L^-T D^-1 z
inline void up(const Pivot& p, Vec3d& z) {
  z = {p.r0 * z.x, p.r1 * z.y, p.r2 * z.z};
  z.y -= p.l21 * z.z;
  z.x -= p.l10 * z.y + p.l20 * z.z;
}
inline Vec3d over(const Pivot& p, Vec3d z) { return {p.r0 * z.x, p.r1 * z.y, p.r2 * z.z}; }

inline void add_block(Block& a, double k, const Symmetric& s) {
  a.c[0][0] += k * s.xx, a.c[0][1] += k * s.xy, a.c[0][2] += k * s.xz;
  a.c[1][0] += k * s.xy, a.c[1][1] += k * s.yy, a.c[1][2] += k * s.yz;
  a.c[2][0] += k * s.xz, a.c[2][1] += k * s.yz, a.c[2][2] += k * s.zz;
}
inline void add_block(Block& a, const Block& b) {
  for (int c = 0; c < 3; ++c) set_column(a, c, column(a, c) + column(b, c));
}
inline int lowest_bit(std::uint64_t w) { return __builtin_ctzll(w); }

}  // namespace

BlockSystem::BlockSystem(int nodes) : m_nodes(nodes), m_words((nodes + 63) / 64) {
  const std::size_t n = std::size_t(nodes);
  for (auto* blocks : {&m_diagonal, &m_next, &m_second, &m_left1, &m_left2}) blocks->resize(n);
  m_front.resize(n * (n + 1) / 2);
  m_rows.resize(n * (n + 1) / 2);
  for (auto* indices : {&m_place, &m_at, &m_touch, &m_degree}) indices->resize(n);
  m_first.resize(n + 1);
  m_linked.resize(n * std::size_t(m_words));
  m_rhs.resize(n);
}

void BlockSystem::open() noexcept {
  for (auto& t : m_touch) t = 0;
  for (auto& w : m_linked) w = 0;
}

void BlockSystem::link(int i, int j) noexcept {
  m_linked[std::size_t(i) * std::size_t(m_words) + std::size_t(j >> 6)] |= std::uint64_t(1) << (j & 63);
  m_linked[std::size_t(j) * std::size_t(m_words) + std::size_t(i >> 6)] |= std::uint64_t(1) << (i & 63);
}

void BlockSystem::couple(const std::int32_t* nodes, int count) noexcept {
  for (int p = 0; p < count; ++p) {
    m_touch[std::size_t(nodes[p])] = 1;
    for (int q = 0; q < p; ++q) link(nodes[p], nodes[q]);
  }
}

void BlockSystem::arrange() noexcept {
  // A run that is eliminated must have two nodes of the front on either side, or an end of the thread.
  for (int i = 0; i < m_nodes; ++i) {
    m_place[i] = -1;
    if (!m_touch[i]) continue;
    const bool before = i > 0 && m_touch[i - 1], after = i + 1 < m_nodes && m_touch[i + 1];
    if (!before && !after) m_touch[i + 1 < m_nodes ? i + 1 : i - 1] = 1;
  }
  int previous = -1;  // the last node of the front before a run
  int left = 0;
  for (int i = 0; i < m_nodes; ++i) {
    if (!m_touch[i]) continue;
    ++left;
    if (i > 0 && m_touch[i - 1]) link(i, i - 1);
    if (i > 1 && m_touch[i - 2]) link(i, i - 2);
    if (previous >= 0 && previous < i - 1) {  // over a run: two nodes before with two after
      const int ends[4] = {previous - 1, previous, i, i + 1 < m_nodes ? i + 1 : i};
      for (int p = 0; p < 4; ++p)
        for (int q = 0; q < p; ++q)
          if (ends[p] != ends[q]) link(ends[p], ends[q]);
    }
    previous = i;
  }
  m_count = left;
  for (int i = 0; i < m_nodes; ++i) {
    if (!m_touch[i]) continue;
    const std::uint64_t* const row = &m_linked[std::size_t(i) * std::size_t(m_words)];
    int degree = 0;
    for (int w = 0; w < m_words; ++w) degree += __builtin_popcountll(row[w]);
    m_degree[i] = degree;
  }
  int filled = 0;
  for (int p = 0; p < m_count; ++p) {
    int best = -1;
    for (int i = 0; i < m_nodes; ++i)
      if (m_touch[i] == 1 && (best < 0 || m_degree[i] < m_degree[best])) best = i;
    m_touch[best] = 2;
    m_place[best] = p;
    m_at[p] = best;
    m_first[p] = filled;
    const std::uint64_t* const row = &m_linked[std::size_t(best) * std::size_t(m_words)];
    for (int w = 0; w < m_words; ++w)
      for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1) m_rows[filled++] = 64 * w + lowest_bit(bits);
    for (int k = m_first[p]; k < filled; ++k) {
      const int j = m_rows[k];
      std::uint64_t* const other = &m_linked[std::size_t(j) * std::size_t(m_words)];
      for (int w = 0; w < m_words; ++w) other[w] |= row[w];
      other[j >> 6] &= ~(std::uint64_t(1) << (j & 63));
      other[best >> 6] &= ~(std::uint64_t(1) << (best & 63));
      int degree = 0;
      for (int w = 0; w < m_words; ++w) degree += __builtin_popcountll(other[w]);
      m_degree[j] = degree;
    }
  }
  m_first[m_count] = filled;
  const Block none{};
  for (int p = 0; p < m_count; ++p) {  // nodes become places, ascending
    std::int32_t* const rows = m_rows.data() + m_first[p];
    const int count = m_first[p + 1] - m_first[p];
    for (int k = 0; k < count; ++k) {
      const std::int32_t place = m_place[rows[k]];
      int q = k;
      for (; q > 0 && rows[q - 1] > place; --q) rows[q] = rows[q - 1];
      rows[q] = place;
    }
    m_front[in_front(p, p)] = none;
    for (int k = 0; k < count; ++k) m_front[in_front(rows[k], p)] = none;
  }
  for (int i = 0; i < m_nodes; ++i) {
    m_diagonal[i] = m_next[i] = m_second[i] = m_left1[i] = m_left2[i] = none;
    m_rhs[i] = {};
  }
}

void BlockSystem::add(int i, int j, double c, const Symmetric& s) noexcept {
  const int reach = i - j;
  if (reach == 0) return add_block(m_diagonal[i], c, s);
  if (reach == 1) return add_block(m_next[j], c, s);
  if (reach == 2) return add_block(m_second[j], c, s);
  const int p = m_place[i], q = m_place[j];
  add_block(m_front[p > q ? in_front(p, q) : in_front(q, p)], c, s);  // symmetric, so its transpose
}

void BlockSystem::add_term(const std::int32_t* nodes, const double* c, int count, const Symmetric& s) noexcept {
  for (int p = 0; p < count; ++p)
    for (int q = 0; q <= p; ++q) add(nodes[p], nodes[q], c[p] * c[q], s);
}

void BlockSystem::add_bend(int i, const Symmetric& s) noexcept {
  add_block(m_diagonal[i - 1], 1, s), add_block(m_diagonal[i], 4, s), add_block(m_diagonal[i + 1], 1, s);
  add_block(m_next[i - 1], -2, s), add_block(m_next[i], -2, s), add_block(m_second[i - 1], 1, s);
}

void BlockSystem::to_front() noexcept {
  const auto put = [this](int i, int j, const Block& b) {  // block (i, j), both in the front
    const int p = m_place[i], q = m_place[j];
    add_block(m_front[p >= q ? in_front(p, q) : in_front(q, p)], p >= q ? b : transposed_block(b));
  };
  for (int i = 0; i < m_nodes; ++i) {
    if (m_place[i] < 0) continue;
    put(i, i, m_diagonal[i]);
    if (i + 1 < m_nodes && m_place[i + 1] >= 0) put(i + 1, i, m_next[i]);
    if (i + 2 < m_nodes && m_place[i + 2] >= 0) put(i + 2, i, m_second[i]);
  }
}

// Nodes first .. last are not in the front; the two before them are, if `bordered`, else the thread begins there.
int BlockSystem::run_forward(int first, int last, bool bordered) noexcept {
  const int b1 = first - 1, b2 = first - 2;
  if (bordered) {
    m_left1[first] = m_next[b1];
    m_left2[first] = m_second[b2];
    if (first + 1 < m_nodes) m_left1[first + 1] = m_second[b1];
    // (first + 1, b2) is zero, and so is the rest. Where the run is one node long, first + 1 is in the front: the
    // block (first + 1, b1) is the front's already, through to_front().
    if (first == last && first + 1 < m_nodes) m_left1[first + 1] = {};
  }
  for (int i = first; i <= last; ++i) {
    Pivot p;
    if (!take_pivot(m_diagonal[i], p)) return i;
    const bool one = i + 1 < m_nodes, two = i + 2 < m_nodes;
    if (one) {
      to_y(m_next[i], p);
      take_off(m_diagonal[i + 1], m_next[i], m_next[i], p);
    }
    if (two) {
      to_y(m_second[i], p);
      take_off(m_next[i + 1], m_second[i], m_next[i], p);
      take_off(m_diagonal[i + 2], m_second[i], m_second[i], p);
    }
    if (!bordered) continue;
    Block& y1 = m_left1[i];
    Block& y2 = m_left2[i];
    // blocks (i, b) are the transposes of (b, i): kept as (b, i) from here
    y1 = transposed_block(y1), y2 = transposed_block(y2);
    to_y(y1, p), to_y(y2, p);
    take_off(m_diagonal[b1], y1, y1, p);
    take_off(m_diagonal[b2], y2, y2, p);
    take_off(m_next[b2], y1, y2, p);
    if (one) take_off(m_left1[i + 1], m_next[i], y1, p), take_off(m_left2[i + 1], m_next[i], y2, p);
    if (two) take_off(m_left1[i + 2], m_second[i], y1, p), take_off(m_left2[i + 2], m_second[i], y2, p);
  }
  return -1;
}

int BlockSystem::run_backward(int first, int last) noexcept {
  for (int i = last; i >= first; --i) {
    Pivot p;
    if (!take_pivot(m_diagonal[i], p)) return i;
    Block& y1 = m_next[i - 1];  // (i, i - 1), wanted as (i - 1, i)
    Block& y2 = m_second[i - 2];
    y1 = transposed_block(y1), y2 = transposed_block(y2);
    to_y(y1, p), to_y(y2, p);
    take_off(m_diagonal[i - 1], y1, y1, p);
    take_off(m_diagonal[i - 2], y2, y2, p);
    take_off(m_next[i - 2], y1, y2, p);
  }
  return -1;
}

int BlockSystem::factor_front() noexcept {
  for (int p = 0; p < m_count; ++p) {
    Pivot pivot;
    if (!take_pivot(m_front[in_front(p, p)], pivot)) return m_at[p];
    const std::int32_t* const rows = m_rows.data() + m_first[p];
    const int count = m_first[p + 1] - m_first[p];
    Block* const own = m_front.data() + in_front(p, p) - p;
    for (int k = 0; k < count; ++k) to_y(own[rows[k]], pivot);
    for (int k = 0; k < count; ++k) {
      Block* const target = m_front.data() + in_front(rows[k], rows[k]) - rows[k];
      Block scaled = own[rows[k]];
      set_column(scaled, 0, pivot.r0 * column(scaled, 0));
      set_column(scaled, 1, pivot.r1 * column(scaled, 1));
      set_column(scaled, 2, pivot.r2 * column(scaled, 2));
      for (int i = k; i < count; ++i) {
        const Block& y = own[rows[i]];
        const Four y0 = column(y, 0), y1 = column(y, 1), y2 = column(y, 2);
        Block& a = target[rows[i]];
        for (int c = 0; c < 3; ++c)
          set_column(a, c, column(a, c) - y0 * scaled.c[0][c] - y1 * scaled.c[1][c] - y2 * scaled.c[2][c]);
      }
    }
  }
  return -1;
}

int BlockSystem::factor() noexcept {
  if (m_count == 0) return run_forward(0, m_nodes - 1, false);
  to_front();
  const auto clear_shared = [this] {
    for (int i = 0; i < m_nodes; ++i) {
      if (m_place[i] < 0) continue;
      m_diagonal[i] = {};
      if (i + 1 < m_nodes && m_place[i + 1] >= 0) m_next[i] = {};
      if (i + 2 < m_nodes && m_place[i + 2] >= 0) m_second[i] = {};
    }
  };
  clear_shared();  // what runs add to them is moved afterwards
  for (int i = 0; i < m_nodes;) {
    if (m_place[i] >= 0) {
      ++i;
      continue;
    }
    const int first = i;
    while (i < m_nodes && m_place[i] < 0) ++i;
    const int last = i - 1;
    int lost;
    if (last == m_nodes - 1 && first > 0)
      lost = run_backward(first, last);
    else
      lost = run_forward(first, last, first > 0);
    if (lost >= 0) return lost;
    if (first > 0 && last < m_nodes - 1) {  // two before with two after: (after, before)
      const auto put = [this](int a, int b, const Block& block) {
        const int p = m_place[a], q = m_place[b];
        add_block(m_front[p >= q ? in_front(p, q) : in_front(q, p)], p >= q ? block : transposed_block(block));
      };
      put(i, first - 1, m_left1[i]), put(i, first - 2, m_left2[i]);
      if (i + 1 < m_nodes) put(i + 1, first - 1, m_left1[i + 1]), put(i + 1, first - 2, m_left2[i + 1]);
      m_left1[i] = m_left2[i] = {};
      if (i + 1 < m_nodes) m_left1[i + 1] = m_left2[i + 1] = {};
    }
  }
  to_front();
  return factor_front();
}

void BlockSystem::solve() noexcept {
  const auto forward_run = [this](int first, int last, bool bordered) {
    for (int i = first; i <= last; ++i) {
      const Pivot p = pivot_of(m_diagonal[i]);
      down(p, m_rhs[i]);
      const Vec3d z = over(p, m_rhs[i]);
      if (i + 1 < m_nodes) pass_down(m_next[i], z, m_rhs[i + 1]);
      if (i + 2 < m_nodes) pass_down(m_second[i], z, m_rhs[i + 2]);
      if (bordered) pass_down(m_left1[i], z, m_rhs[first - 1]), pass_down(m_left2[i], z, m_rhs[first - 2]);
    }
  };
  const auto forward_back = [this](int first, int last, bool bordered) {
    for (int i = last; i >= first; --i) {
      if (i + 1 < m_nodes) pass_up(m_next[i], m_rhs[i + 1], m_rhs[i]);
      if (i + 2 < m_nodes) pass_up(m_second[i], m_rhs[i + 2], m_rhs[i]);
      if (bordered) pass_up(m_left1[i], m_rhs[first - 1], m_rhs[i]), pass_up(m_left2[i], m_rhs[first - 2], m_rhs[i]);
      up(pivot_of(m_diagonal[i]), m_rhs[i]);
    }
  };
  const auto runs = [this](auto&& visit) {
    for (int i = 0; i < m_nodes;) {
      if (m_place[i] >= 0) {
        ++i;
        continue;
      }
      const int first = i;
      while (i < m_nodes && m_place[i] < 0) ++i;
      visit(first, i - 1);
    }
  };
  const auto is_tail = [this](int first, int last) { return last == m_nodes - 1 && first > 0; };
  runs([&](int first, int last) {
    if (!is_tail(first, last)) return forward_run(first, last, first > 0);
    for (int i = last; i >= first; --i) {
      const Pivot p = pivot_of(m_diagonal[i]);
      down(p, m_rhs[i]);
      const Vec3d z = over(p, m_rhs[i]);
      pass_down(m_next[i - 1], z, m_rhs[i - 1]);
      pass_down(m_second[i - 2], z, m_rhs[i - 2]);
    }
  });
  for (int p = 0; p < m_count; ++p) {
    const Block* const own = m_front.data() + in_front(p, p) - p;
    const Pivot pivot = pivot_of(own[p]);
    Vec3d& b = m_rhs[m_at[p]];
    down(pivot, b);
    const Vec3d z = over(pivot, b);
    for (int k = m_first[p]; k < m_first[p + 1]; ++k) pass_down(own[m_rows[k]], z, m_rhs[m_at[m_rows[k]]]);
  }
  for (int p = m_count - 1; p >= 0; --p) {
    const Block* const own = m_front.data() + in_front(p, p) - p;
    Vec3d& b = m_rhs[m_at[p]];
    for (int k = m_first[p]; k < m_first[p + 1]; ++k) pass_up(own[m_rows[k]], m_rhs[m_at[m_rows[k]]], b);
    up(pivot_of(own[p]), b);
  }
  runs([&](int first, int last) {
    if (!is_tail(first, last)) return forward_back(first, last, first > 0);
    for (int i = first; i <= last; ++i) {
      pass_up(m_next[i - 1], m_rhs[i - 1], m_rhs[i]);
      pass_up(m_second[i - 2], m_rhs[i - 2], m_rhs[i]);
      up(pivot_of(m_diagonal[i]), m_rhs[i]);
    }
  });
}

}  // namespace trocar::suture
