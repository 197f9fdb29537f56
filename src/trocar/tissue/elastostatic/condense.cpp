#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/elastostatic/dense_kernels.hpp>
#include <trocar/tissue/elastostatic/front.hpp>

namespace trocar::tissue {
namespace {

void check_kept(const Stiffness& k, std::span<const int> kept) {
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i] < 0 || kept[i] >= k.nodes() || (i > 0 && kept[i] <= kept[i - 1]))
      throw std::invalid_argument("kept nodes: ascending, each once; got " + std::to_string(kept[i]));
}

void check_numbers(const Stiffness& k, std::span<const double> loads) {
  for (int i = 0; i < k.nodes(); ++i)
    if (!finite(k.points[std::size_t(i)])) refuse_unheld(i);
  if (k.nodes() == 0 ? !loads.empty() : loads.size() % (3 * k.points.size()) != 0)
    throw std::invalid_argument("loads: three numbers for every node each");
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (!std::isfinite(loads[i]))
      throw std::invalid_argument("force on node " + std::to_string(i / 3 % k.points.size()) + " is not a number");
}

/// Where -K^-1 and the loads' rows stand, as the root leaves them.
struct RootMatrix {
  const AlignedNumbers& store;
  int height, border;  ///< unknowns; those that are not loads, with what fills up
};

/// Rows of loads, as they stand below the inverse.
std::vector<double> take_fields(const RootMatrix& root, int loads, int unknowns) {
  std::vector<double> fields;
  for (int load = 0; load < loads; ++load)
    for (int j = 0; j < unknowns; ++j)
      fields.push_back(root.store.data()[std::size_t(root.border + load) + std::size_t(j) * std::size_t(root.height)]);
  return fields;
}

/// From the lower triangle of -C to that of C, without what filled up.
std::vector<double> take_compliance(const RootMatrix& root, int n) {
  const std::size_t size = std::size_t(n), height = std::size_t(root.height);
  const double* const from = root.store.data();
  std::vector<double> to;
  to.reserve(size * size);
  ask_for_huge_pages(to.data(), size * size * sizeof(double));
  for (std::size_t j = 0; j < size; ++j) {
    to.resize((j + 1) * size);
    for (std::size_t i = j; i < size; ++i) to[j * size + i] = -from[j * height + i];
  }
  return to;
}

void clear_held(const std::vector<bool>& held, std::vector<double>& c) {
  const std::size_t n = held.size();
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j; i < n; ++i)
      if (held[i] || held[j]) c[j * n + i] = 0;
}

/// The upper triangle from the lower one, in squares that fit the cache.
void mirror(std::size_t n, std::vector<double>& c) {
  constexpr std::size_t kSquare = 32;
  for (std::size_t j0 = 0; j0 < n; j0 += kSquare)
    for (std::size_t i0 = j0; i0 < n; i0 += kSquare)
      for (std::size_t j = j0; j < std::min(j0 + kSquare, n); ++j)
        for (std::size_t i = std::max(i0, j + 1); i < std::min(i0 + kSquare, n); ++i) c[i * n + j] = c[j * n + i];
}

/// Reports the progress, in shares of the work.
struct Progress {
  const std::function<void(double)>& said;
  double all = 0, done = 0;
  void tell(double now) const {
    if (said) said(all > 0 ? std::min(now / all, 1.0) : 1.0);
  }
  void add(double work) { tell(done += work); }
};

}  // namespace

void refuse_unheld(int node) {
  throw NotHeld(
      "nothing holds the body at node " + std::to_string(node) + ", nothing there has stiffness, or it buckles", node);
}

Condensed condense(const Stiffness& k, std::span<const int> kept, std::span<const double> loads, core::ThreadPool* pool,
                   const std::function<void(double)>& said) {
  check_kept(k, kept), check_numbers(k, loads);
  const Dissection order = dissect(k, kept);
  FrontSource source(k, order, loads);
  const int fronts = int(order.fronts.size()), n = 3 * int(kept.size());
  Progress progress{said};
  for (int f = 0; f < fronts; ++f) progress.all += source.size(f).eliminated();
  const FrontSize root = source.size(fronts - 1);
  progress.all += double(root.border) * root.border * root.rest();
  progress.tell(0);

  std::vector<AlignedNumbers> left(order.fronts.size());
  for (int f = 0; f < fronts; ++f) source.eliminate_front(f, left, pool), progress.add(source.size(f).eliminated());

  AlignedNumbers& rest = left.back();
  const LowerMatrix matrix{rest.data(), root.rest()};
  for (int i = n; i < root.border; ++i) matrix(i, i) = 1;
  std::vector<double> original(std::size_t(root.border), 0.0);
  std::vector<bool> held;
  for (int i = 0; i < n; ++i) {
    original[std::size_t(i)] = source.diagonal(kept[std::size_t(i / 3)], i % 3);
    held.push_back(k.held[std::size_t(kept[std::size_t(i / 3)])] >> i % 3 & 1);
  }
  const int failed = invert_in_place(matrix, root.border, root.rest(), original.data(), pool, [&](int columns) {
    progress.tell(progress.done + double(columns) * root.border * root.rest());
  });
  if (failed >= 0) refuse_unheld(kept[std::size_t(failed / 3)]);

  Condensed out{int(kept.size()), {}, {}};
  const RootMatrix done{rest, root.rest(), root.border};
  out.fields = take_fields(done, k.nodes() > 0 ? int(loads.size() / (3 * k.points.size())) : 0, n);
  out.compliance = take_compliance(done, n);
  if (std::find(held.begin(), held.end(), true) != held.end()) clear_held(held, out.compliance);
  rest.free();
  mirror(std::size_t(n), out.compliance);
  progress.tell(progress.all);
  return out;
}

double memory_to_condense(int nodes, int kept) noexcept {
  // The root's nodes cut the body in two; each half has left a matrix of these, and of half of what is kept (more,
  // where halves differ).
  const double inner = std::max(nodes - kept, 0), side = std::sqrt(std::sqrt(inner));
  const double cut = 3 * std::min(inner, 32 + 2.5 * side * side * std::sqrt(side)), whole = 3 * double(kept) + 16;
  const double half = std::min(0.65 * whole + cut, whole + cut);
  const double fronts = whole * whole + (whole + cut) * cut + 3.0 * half * half;
  const double inverse = whole * whole + std::max(whole * whole, kBlock * (whole + 2 * kBlock));
  return 8 * std::max(fronts, inverse) + 2000.0 * nodes;
}

}  // namespace trocar::tissue
