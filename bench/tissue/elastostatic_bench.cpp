// How long it takes to condense an organ to its surface, on one thread, and beside it, in the same run, what libraries
// take: supernodal CHOLMOD in the same order, the surface last, and LAPACK's dpotri of the factor's last square; dense
// Cholesky and inverse of the whole; unit forces by conjugate gradients, as the paper has it. "difference": the
// largest, of the largest element.
//
//   tissue_bench --benchmark_filter=condense        20,000 nodes (3 GB) where TROCAR_BENCH_LARGE is set
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <benchmark/benchmark.h>

#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/elastostatic/dissection.hpp>

#include "lattice_organ.hpp"

#ifdef TROCAR_CHOLMOD
#include <suitesparse/cholmod.h>
extern "C" {
void dpotrf_(const char*, const int*, double*, const int*, int*);
void dpotri_(const char*, const int*, double*, const int*, int*);
}
#endif

namespace {

using namespace trocar;
using namespace trocar::tissue;

/// About 500, 1,000, 3,000, 10,000 and 20,000 nodes.
LatticeOrgan organ_of(std::int64_t nodes) {
  if (nodes <= 500) return {8, 8, 8};
  if (nodes <= 1000) return {10, 10, 10};
  if (nodes <= 3000) return {15, 15, 13};
  if (nodes <= 10000) return {22, 22, 20};
  return {28, 27, 26};
}

void condense_organ(benchmark::State& bench) {
  const LatticeOrgan organ = organ_of(bench.range(0));
  for (auto _ : bench) benchmark::DoNotOptimize(condense(organ.k, organ.kept));
  organ.count(bench);
  bench.counters["MB"] = 1e-6 * memory_to_condense(organ.k.nodes(), int(organ.kept.size()));
}
BENCHMARK(condense_organ)->Arg(500)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMillisecond);
const bool large = [] {
  if (std::getenv("TROCAR_BENCH_LARGE"))
    benchmark::RegisterBenchmark("condense_organ_large", condense_organ)->Arg(20000)->Unit(benchmark::kMillisecond);
  return true;
}();

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::fabs(a[i] - b[i])), size = std::max(size, std::fabs(a[i]));
  return a.size() == b.size() ? most / size : INFINITY;
}

void condense_unit_forces(benchmark::State& bench) {
  const LatticeOrgan organ = organ_of(bench.range(0));
  Condensed c;
  for (auto _ : bench) c = condense_by_unit_forces(organ.k, organ.kept);
  organ.count(bench);
  bench.counters["difference"] = difference(condense(organ.k, organ.kept).compliance, c.compliance);
}
BENCHMARK(condense_unit_forces)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

#ifdef TROCAR_CHOLMOD

/// CHOLMOD with K's rows in our order, nested dissection, the surface last: its own cannot be told what to keep.
struct CholmodOrgan {
  cholmod_common c;
  cholmod_sparse* a = nullptr;
  std::vector<int> given;  ///< order of elimination

  explicit CholmodOrgan(const LatticeOrgan& organ) {
    cholmod_start(&c);
    c.supernodal = CHOLMOD_SUPERNODAL;
    c.final_ll = 1;
    c.nmethods = 1, c.method[0].ordering = CHOLMOD_GIVEN, c.postorder = 0;
    const Stiffness& k = organ.k;
    const std::vector<int> at = dissect(k, organ.kept).place;
    for (int i = 0; i < 3 * k.nodes(); ++i) given.push_back(i);
    const std::size_t n = 3 * k.points.size();
    cholmod_triplet* t = cholmod_allocate_triplet(n, n, 9 * k.column.size(), -1, CHOLMOD_REAL, &c);
    for (int row = 0; row < k.nodes(); ++row)
      for (int e = k.first[std::size_t(row)]; e < k.first[std::size_t(row) + 1]; ++e)
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < (k.column[std::size_t(e)] == row ? p + 1 : 3); ++q) {
            const int i = 3 * at[std::size_t(row)] + p, j = 3 * at[std::size_t(k.column[std::size_t(e)])] + q;
            static_cast<int*>(t->i)[t->nnz] = std::max(i, j);
            static_cast<int*>(t->j)[t->nnz] = std::min(i, j);
            static_cast<double*>(t->x)[t->nnz++] = k.block[std::size_t(e)].m[p][q];
          }
    a = cholmod_triplet_to_sparse(t, 0, &c);
    cholmod_free_triplet(&t, &c);
  }
  ~CholmodOrgan() { cholmod_free_sparse(&a, &c), cholmod_finish(&c); }
  CholmodOrgan(const CholmodOrgan&) = delete;
  CholmodOrgan& operator=(const CholmodOrgan&) = delete;

  /// Of the kept unknowns, lower triangle of the inverse by columns.
  std::vector<double> compliance(int n) {
    cholmod_factor* f = cholmod_analyze_p(a, given.data(), nullptr, 0, &c);
    cholmod_factorize(a, f, &c);
    std::vector<double> last(std::size_t(n) * std::size_t(n), 0.0);
    copy_last(*f, n, last);
    cholmod_free_factor(&f, &c);
    int info = 0;
    dpotri_("L", &n, last.data(), &n, &info);
    for (std::size_t j = 0; j < std::size_t(n); ++j)
      for (std::size_t i = 0; i < j; ++i) last[j * std::size_t(n) + i] = last[i * std::size_t(n) + j];
    return last;
  }
  static void copy_last(const cholmod_factor& f, int n, std::vector<double>& to) {
    const int *super = static_cast<int*>(f.super), *pi = static_cast<int*>(f.pi), *px = static_cast<int*>(f.px);
    const int *rows = static_cast<int*>(f.s), begin = int(f.n) - n;
    for (std::size_t s = 0; s < f.nsuper; ++s)
      for (int j = std::max(super[s], begin); j < super[s + 1]; ++j)
        for (int r = 0; r < pi[s + 1] - pi[s]; ++r) {
          const int row = rows[pi[s] + r];
          const double x = static_cast<double*>(f.x)[px[s] + (j - super[s]) * (pi[s + 1] - pi[s]) + r];
          if (row >= j) to[std::size_t(j - begin) * std::size_t(n) + std::size_t(row - begin)] = x;
        }
  }
};

void condense_cholmod(benchmark::State& bench) {
  const LatticeOrgan organ = organ_of(bench.range(0));
  CholmodOrgan peer(organ);
  std::vector<double> c;
  for (auto _ : bench) c = peer.compliance(3 * int(organ.kept.size()));
  organ.count(bench);
  bench.counters["difference"] = difference(condense(organ.k, organ.kept).compliance, c);
}
BENCHMARK(condense_cholmod)->Arg(500)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMillisecond);

void condense_dense_lapack(benchmark::State& bench) {
  const LatticeOrgan organ = organ_of(bench.range(0));
  const int n = 3 * organ.k.nodes();
  std::vector<double> whole(std::size_t(n) * std::size_t(n), 0.0), work;
  for (int row = 0; row < organ.k.nodes(); ++row)
    for (int e = organ.k.first[std::size_t(row)]; e < organ.k.first[std::size_t(row) + 1]; ++e)
      for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q)
          whole[std::size_t(3 * row + p) + std::size_t(3 * organ.k.column[std::size_t(e)] + q) * std::size_t(n)] =
              organ.k.block[std::size_t(e)].m[p][q];
  for (auto _ : bench) {
    work = whole;
    int info = 0;
    dpotrf_("L", &n, work.data(), &n, &info);
    dpotri_("L", &n, work.data(), &n, &info);
    benchmark::DoNotOptimize(info);
  }
  organ.count(bench);
}
BENCHMARK(condense_dense_lapack)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

#endif

}  // namespace
