#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <vector>

#include <trocar/tissue/elastostatic/dense.hpp>
#include <trocar/tissue/elastostatic/dense_kernels.hpp>

namespace trocar::tissue {
namespace {

constexpr int kTaskGroups = 10;   // groups of packs of rows in a task: with kBlock columns they fit the second cache
constexpr int kTaskColumns = 60;  // packs of columns in a task
constexpr double kWorthIt = 1e6;  // products below which threads are not woken

template <class F>
void share_out(core::ThreadPool* pool, bool worth_it, int count, F body) {
  if (pool && worth_it) return core::run(*pool, count, body);
  for (int i = 0; i < count; ++i) body(i);
}

/// Cholesky factor of eight columns, its diagonal as its inverse. @return the pivot that failed, or -1
int factor_eight(const double* tile, const double* original, double* l) noexcept {
  for (int j = 0; j < kPack; ++j) {
    double pivot = tile[j * kPack + j];
    for (int k = 0; k < j; ++k) pivot = pivot - l[k * kPack + j] * l[k * kPack + j];
    if (!(pivot > 0 && pivot > kLeastPivot * std::fabs(original[j]) && pivot < 1e300)) return j;
    const double inverse = 1 / std::sqrt(pivot);
    l[j * kPack + j] = inverse;
    for (int i = j + 1; i < kPack; ++i) {
      double sum = tile[j * kPack + i];
      for (int k = 0; k < j; ++k) sum = sum - l[k * kPack + i] * l[k * kPack + j];
      l[j * kPack + i] = sum * inverse;
    }
  }
  return -1;
}

/// A block of columns of packed rows, and its Cholesky factor, packed too, with the inverse of the diagonal.
struct BlockColumns {
  PackedRows x;       ///< from the block's first column on
  int columns;        ///< a multiple of eight, at most kBlock
  PackedRows factor;  ///< (columns x columns)
  const double* diagonal(int j) const noexcept { return factor.pack(j) + kPack * kPack * j; }
};

/// Of the rows of the factor itself, which is in place the block's own rows. @return as factor_eight
int factor_block(const DenseKernels& dense, const BlockColumns& b, const double* original) noexcept {
  const int packs = b.columns / kPack;
  for (int j = 0; j < packs; ++j) {
    for (int i = j; i < packs; ++i)
      dense.subtract(1, kPack * j, b.factor.pack(i), b.factor.step, b.factor.pack(j),
                     {b.factor.pack(i) + kPack * kPack * j, b.factor.step, kPack});
    double* const tile = b.factor.pack(j) + kPack * kPack * j;
    double l[kPack * kPack] = {};
    const int failed = factor_eight(tile, original + kPack * j, l);
    if (failed >= 0) return kPack * j + failed;
    std::copy(l, l + kPack * kPack, tile);
    for (int i = j + 1; i < packs; ++i)
      dense.solve_forward(1, tile, {b.factor.pack(i) + kPack * kPack * j, b.factor.step, kPack});
  }
  return -1;
}

/// Y = A L^-T of some packs of rows, in place.
void solve_rows(const DenseKernels& dense, const BlockColumns& b, int first, int packs) noexcept {
  double* const x = b.x.pack(first);
  for (int j = 0; j < b.columns / kPack; ++j) {
    const DenseTile tile{x + kPack * kPack * j, b.x.step, kPack};
    dense.subtract(packs, kPack * j, x, b.x.step, b.factor.pack(j), tile);
    dense.solve_forward(packs, b.diagonal(j), tile);
  }
}

/// Y L^-1 of some packs of rows, in place. @param turned  L^T, packed
void solve_rows_back(const DenseKernels& dense, const BlockColumns& b, PackedRows turned, int first,
                     int packs) noexcept {
  double* const x = b.x.pack(first);
  for (int j = b.columns / kPack - 1; j >= 0; --j) {
    const int from = kPack * (j + 1);
    const DenseTile tile{x + kPack * kPack * j, b.x.step, kPack};
    dense.subtract(packs, b.columns - from, x + kPack * from, b.x.step, turned.pack(j) + kPack * from, tile);
    dense.solve_backward(packs, b.diagonal(j), tile);
  }
}

/// Packs of rows from `first` on, without those from `left_out` to `left_out_end`, in groups that begin at multiples of
/// kGroup from the first.
struct Groups {
  std::vector<std::int32_t> first;
  std::vector<std::int32_t> packs;
  Groups(int begin, int end, int left_out = 0, int left_out_end = 0) {
    const auto add = [this](int from, int to) {
      for (int i = from; i < to; i += kGroup) first.push_back(i), packs.push_back(std::min(kGroup, to - i));
    };
    if (left_out_end <= left_out) left_out = left_out_end = begin;
    add(begin, left_out), add(left_out_end, end);
  }
  int count() const noexcept { return int(first.size()); }
};

/// Where tile (i, j) of what is updated stands: by packs of rows and of columns.
struct UpdateTarget {
  PackedRows packed;       ///< columns before `packed_columns`
  int packed_columns = 0;  ///< packs
  LowerMatrix rest;        ///< begins at row and column `rest_first`
  int rest_first = 0;      ///< packs
  DenseTile at(int i, int j) const noexcept {
    if (j < packed_columns) return {packed.pack(i) + kPack * kPack * j, packed.step, kPack};
    return {&rest(kPack * (i - rest_first), kPack * (j - rest_first)), kPack, rest.height};
  }
};

/// Lower triangle of the target -= Y Y^T. @param y  rows by the target's numbers; `count` columns
void subtract_squares(const DenseKernels& dense, PackedRows y, int count, const Groups& groups,
                      const std::vector<std::int32_t>& columns, const UpdateTarget& target, core::ThreadPool* pool) {
  struct Task {
    int group, column;
  };
  std::vector<Task> tasks;
  for (int g = 0; g < groups.count(); g += kTaskGroups) {
    const int last = std::min(g + kTaskGroups, groups.count()) - 1;
    const int below = groups.first[std::size_t(last)] + groups.packs[std::size_t(last)];
    for (int c = 0; c < int(columns.size()) && columns[std::size_t(c)] < below; c += kTaskColumns)
      tasks.push_back({g, c});
  }
  const auto body = [&](int t) noexcept {
    const Task task = tasks[std::size_t(t)];
    const int group_end = std::min(task.group + kTaskGroups, groups.count());
    const int column_end = std::min(task.column + kTaskColumns, int(columns.size()));
    for (int c = task.column; c < column_end; ++c) {
      const int j = columns[std::size_t(c)];
      for (int g = task.group; g < group_end; ++g) {
        const int end = groups.first[std::size_t(g)] + groups.packs[std::size_t(g)];
        const int i = std::max(groups.first[std::size_t(g)], j);
        if (i < end) dense.subtract(end - i, count, y.pack(i), y.step, y.pack(j), target.at(i, j));
      }
    }
  };
  const double work = 32.0 * count * double(groups.count()) * double(columns.size());
  share_out(pool, work > kWorthIt, int(tasks.size()), body);
}

std::vector<std::int32_t> columns_without(int begin, int end, int left_out = 0, int left_out_end = 0) {
  std::vector<std::int32_t> columns;
  for (int j = begin; j < end; ++j)
    if (j < left_out || j >= left_out_end) columns.push_back(j);
  return columns;
}

/// The sweep's block of columns: out of the triangle, packed, and back.
struct SweepBlock {
  LowerMatrix a;
  int begin, end;  ///< columns
  PackedRows x;
  int width() const noexcept { return end - begin; }
  void take_pack(int p) const noexcept {
    for (int i = kPack * p; i < kPack * (p + 1); ++i)
      for (int k = 0; k < width(); ++k) x(i, k) = i >= begin + k ? a(i, begin + k) : a(begin + k, i);
  }
  void put_pack(int p) const noexcept {
    for (int i = kPack * p; i < kPack * (p + 1); ++i)
      for (int k = 0; k < width(); ++k) (i >= end ? a(i, begin + k) : a(begin + k, i)) = x(i, k);
  }
  /// Its own rows. @param inverse  (width x width) packed
  void put_own(PackedRows inverse) const noexcept {
    for (int i = 0; i < width(); ++i)
      for (int k = 0; k <= i; ++k) a(begin + i, begin + k) = -inverse(i, k);
  }
};

/// L^T of a packed L; the diagonal does not matter.
void turn_factor(PackedRows factor, int n, PackedRows turned) noexcept {
  for (int j = 0; j < n; ++j)
    for (int k = j + 1; k < n; ++k) turned(j, k) = factor(k, j);
}

/// (L L^T)^-1, packed. @param turned  L^T
void invert_block(const DenseKernels& dense, PackedRows factor, PackedRows turned, int n, PackedRows inverse) noexcept {
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) inverse(i, k) = i == k ? 1.0 : 0.0;
  const BlockColumns own{inverse, n, factor};
  for (int p = 0; p < n / kPack; p += kGroup) {
    const int packs = std::min(kGroup, n / kPack - p);
    solve_rows(dense, own, p, packs);
    solve_rows_back(dense, own, turned, p, packs);
  }
}

}  // namespace

void ask_for_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kPage = 4096, kWorthPages = 1 << 20;
  const std::uintptr_t from = (reinterpret_cast<std::uintptr_t>(begin) + kPage - 1) / kPage * kPage;
  const std::uintptr_t to = (reinterpret_cast<std::uintptr_t>(begin) + bytes) / kPage * kPage;
  if (bytes > kWorthPages) madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#endif
}

void AlignedNumbers::assign(std::size_t n) {
  free();
  m_store.reset(static_cast<double*>(std::calloc(n + kPack, sizeof(double))));
  if (!m_store) throw std::bad_alloc();
  ask_for_huge_pages(m_store.get(), (n + kPack) * sizeof(double));
}

double* AlignedNumbers::data() const noexcept {
  const auto at = reinterpret_cast<std::uintptr_t>(m_store.get());
  return m_store.get() + (64 - at % 64) % 64 / sizeof(double);
}

int eliminate(PackedRows x, int rows, int pivots, const double* original, LowerMatrix rest, core::ThreadPool* pool) {
  const DenseKernels& dense = dense_kernels();
  for (int begin = 0; begin < pivots; begin += kBlock) {
    const int end = std::min(begin + kBlock, pivots);
    const PackedRows here{x.at + kPack * begin, x.step};
    const BlockColumns block{here, end - begin, {here.pack(begin / kPack), x.step}};
    const int failed = factor_block(dense, block, original + begin);
    if (failed >= 0) return begin + failed;
    const Groups below(end / kPack, rows / kPack);
    const double work = double(rows - end) * block.columns * block.columns;
    share_out(pool, work > kWorthIt, below.count(), [&](int g) noexcept {
      solve_rows(dense, block, below.first[std::size_t(g)], below.packs[std::size_t(g)]);
    });
    subtract_squares(dense, here, block.columns, below, columns_without(end / kPack, rows / kPack),
                     {x, pivots / kPack, rest, pivots / kPack}, pool);
  }
  return -1;
}

int invert_in_place(LowerMatrix a, int n, int rows, const double* original, core::ThreadPool* pool,
                    const std::function<void(int)>& said) {
  const DenseKernels& dense = dense_kernels();
  const int widest = std::min(kBlock, n), packs = rows / kPack;
  AlignedNumbers taken, own_rows, turned_rows;
  taken.assign(std::size_t(rows) * std::size_t(widest));
  for (AlignedNumbers* square : {&own_rows, &turned_rows}) square->assign(std::size_t(widest) * std::size_t(widest));
  for (int begin = 0; begin < n; begin += kBlock) {
    const int end = std::min(begin + kBlock, n), width = end - begin, first = begin / kPack, last = end / kPack;
    const PackedRows x{taken.data(), kPack * width}, own{own_rows.data(), kPack * width};
    const SweepBlock sweep{a, begin, end, x};
    share_out(pool, true, packs, [&](int p) noexcept { sweep.take_pack(p); });
    const BlockColumns block{x, width, {x.pack(first), x.step}};
    const int failed = factor_block(dense, block, original + begin);
    if (failed >= 0) return begin + failed;
    const PackedRows turned{turned_rows.data(), kPack * width};
    turn_factor(block.factor, width, turned);
    const Groups others(0, packs, first, last);
    share_out(pool, true, others.count(), [&](int g) noexcept {
      solve_rows(dense, block, others.first[std::size_t(g)], others.packs[std::size_t(g)]);
    });
    subtract_squares(dense, x, width, others, columns_without(0, n / kPack, first, last), {x, 0, a, 0}, pool);
    share_out(pool, true, others.count(), [&](int g) noexcept {
      const int from = others.first[std::size_t(g)], count = others.packs[std::size_t(g)];
      solve_rows_back(dense, block, turned, from, count);
      for (int p = from; p < from + count; ++p) sweep.put_pack(p);
    });
    invert_block(dense, block.factor, turned, width, own);
    sweep.put_own(own);
    if (said) said(end);
  }
  return -1;
}

}  // namespace trocar::tissue
