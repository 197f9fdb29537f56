// Dense elimination's loops, for one instruction set: TROCAR_DENSE_KERNELS names the table, TROCAR_DENSE_NAME what it
// is, TROCAR_DENSE_LANE how many numbers a register has, and TROCAR_DENSE_LANES and TROCAR_DENSE_COLUMNS the size of
// the tile that stays in registers. Everything here has internal linkage and nothing comes from a header but types, so
// that no file shares wide code with another.
#include <utility>

#include <trocar/tissue/elastostatic/dense_kernels.hpp>

namespace trocar::tissue {
namespace {

constexpr int kLane = TROCAR_DENSE_LANE;
typedef double Lane __attribute__((vector_size(kLane * 8)));

#define TROCAR_INLINE static inline __attribute__((always_inline))

TROCAR_INLINE Lane load(const double* p) {
  Lane a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
TROCAR_INLINE void store(const Lane& a, double* p) { __builtin_memcpy(p, &a, sizeof a); }

/// What is kept in registers: column j of some lanes of rows.
template <int Lanes>
struct Column {
  Lane row[Lanes];
};

/// Distance of a tile's lanes: within a pack, or from pack to pack where a lane is a pack.
template <int Lanes, class Index = std::make_integer_sequence<int, Lanes>>
struct Rows;
template <int Lanes, int... I>
struct Rows<Lanes, std::integer_sequence<int, I...>> {
  TROCAR_INLINE void load_column(Column<Lanes>& to, const double* p, std::ptrdiff_t step) {
    ((to.row[I] = load(p + I * step)), ...);
  }
  TROCAR_INLINE void store_column(const Column<Lanes>& from, double* p, std::ptrdiff_t step) {
    (store(from.row[I], p + I * step), ...);
  }
  TROCAR_INLINE void prefetch_column(const double* p, std::ptrdiff_t step) {
    (__builtin_prefetch(p + I * step, 1), ...);
  }
  TROCAR_INLINE void subtract_product(Column<Lanes>& c, const Column<Lanes>& a, double b) {
    ((c.row[I] = c.row[I] - a.row[I] * b), ...);
  }
};

/// A tile of `Lanes` lanes of rows and as many columns as J has.
template <int Lanes, int... J>
TROCAR_INLINE void subtract_tile(int count, const double* a, std::ptrdiff_t a_step, const double* b, double* c,
                                 std::ptrdiff_t column, std::ptrdiff_t c_step, std::integer_sequence<int, J...>) {
  Column<Lanes> sum[sizeof...(J)], own;
  (Rows<Lanes>::load_column(sum[J], c + J * column, c_step), ...);
  if constexpr (kLane == kPack)  // the rows that come next
    (Rows<Lanes>::prefetch_column(c + J * column + kGroup * c_step, c_step), ...);
  for (int k = 0; k < count; ++k, a += kPack, b += kPack) {
    Rows<Lanes>::load_column(own, a, a_step);
    (Rows<Lanes>::subtract_product(sum[J], own, b[J]), ...);
  }
  (Rows<Lanes>::store_column(sum[J], c + J * column, c_step), ...);
}

#if TROCAR_DENSE_LANE == 8
template <int Packs>
void subtract_packs(int count, const double* a, std::ptrdiff_t pack, const double* b, const DenseTile& c) {
  subtract_tile<Packs>(count, a, pack, b, c.at, c.column, c.pack, std::make_integer_sequence<int, kPack>());
}
void subtract(int packs, int count, const double* a, std::ptrdiff_t pack, const double* b, const DenseTile& c) {
  if (packs == 3) return subtract_packs<3>(count, a, pack, b, c);
  if (packs == 2) return subtract_packs<2>(count, a, pack, b, c);
  subtract_packs<1>(count, a, pack, b, c);
}
#else
void subtract(int packs, int count, const double* a, std::ptrdiff_t pack, const double* b, const DenseTile& c) {
  constexpr int kRows = TROCAR_DENSE_LANES * kLane, kColumns = TROCAR_DENSE_COLUMNS;
  for (int p = 0; p < packs; ++p)
    for (int row = 0; row < kPack; row += kRows)
      for (int j = 0; j < kPack; j += kColumns)
        subtract_tile<TROCAR_DENSE_LANES>(count, a + p * pack + row, kLane, b + j,
                                          c.at + p * c.pack + j * c.column + row, c.column, kLane,
                                          std::make_integer_sequence<int, kColumns>());
}
#endif

void solve_forward(int packs, const double* l, const DenseTile& c) {
  for (int p = 0; p < packs; ++p)
    for (int row = 0; row < kPack; row += kLane) {
      double* const at = c.at + p * c.pack + row;
      Lane x[kPack];
      for (int j = 0; j < kPack; ++j) {
        x[j] = load(at + j * c.column);
        for (int k = 0; k < j; ++k) x[j] = x[j] - x[k] * l[k * kPack + j];
        x[j] = x[j] * l[j * kPack + j];
        store(x[j], at + j * c.column);
      }
    }
}

void solve_backward(int packs, const double* l, const DenseTile& c) {
  for (int p = 0; p < packs; ++p)
    for (int row = 0; row < kPack; row += kLane) {
      double* const at = c.at + p * c.pack + row;
      Lane x[kPack];
      for (int j = kPack - 1; j >= 0; --j) {
        x[j] = load(at + j * c.column);
        for (int k = kPack - 1; k > j; --k) x[j] = x[j] - x[k] * l[j * kPack + k];
        x[j] = x[j] * l[j * kPack + j];
        store(x[j], at + j * c.column);
      }
    }
}

constexpr DenseKernels kDenseTable{
    .name = TROCAR_DENSE_NAME, .subtract = subtract, .solve_forward = solve_forward, .solve_backward = solve_backward};

}  // namespace

const DenseKernels* TROCAR_DENSE_KERNELS() noexcept { return &kDenseTable; }

}  // namespace trocar::tissue
