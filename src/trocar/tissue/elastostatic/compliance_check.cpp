#include <algorithm>
#include <cmath>
#include <vector>

#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/core/text.hpp>
#include <trocar/tissue/elastostatic/compliance_check.hpp>
#include <trocar/tissue/elastostatic/solve.hpp>

namespace trocar::tissue {
namespace {

constexpr double kRounding = 1e-5;  // of a float, and of two that are the same figure
constexpr double kAgrees = 1e-3;    // of a row's sum of magnitudes: far above rounding, far below what can be felt
constexpr double kSolved = 1e-9;

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

class Check {
 public:
  Check(const Stiffness& k, std::span<const int> kept, std::span<const float> columns)
      : m_k(k), m_kept(kept), m_columns(columns), m_n(3 * kept.size()), m_solver(k) {
    m_random = core::Random(core::hash_bytes(columns.data(), columns.size_bytes()));
  }

  std::string matrix() const {
    for (std::size_t j = 0; j < m_n; ++j)
      if (is_held(j) ? at(j, j) != 0 : !(at(j, j) > 0)) return tr("its diagonal is not positive");
    constexpr std::size_t kSquare = 32;  // fits the cache
    for (std::size_t j = 0; j < m_n; j += kSquare)
      for (std::size_t i = j; i < m_n; i += kSquare)
        if (!symmetric({i, std::min(i + kSquare, m_n)}, {j, std::min(j + kSquare, m_n)}))
          return tr("it is not symmetric");
    return {};
  }

  /// Under forces of 1 N everywhere.
  std::string forces() {
    std::vector<double> force(3 * m_k.points.size(), 0.0), expected(m_n, 0.0), scale(m_n, 0.0);
    for (std::size_t j = 0; j < m_n; ++j) {
      const double sign = next_sign();
      if (is_held(j)) continue;
      force[unknown(j)] = sign;
      add_column(m_columns.subspan(j * m_n, m_n), sign, expected, scale);
    }
    return compare(force, expected, scale);
  }

  /// Under all loads together, each as large as the others.
  std::string fields(std::span<const double> loads, std::span<const float> fields) {
    const std::size_t nodes = 3 * m_k.points.size(), count = nodes > 0 ? loads.size() / nodes : 0;
    std::vector<double> force(nodes, 0.0), expected(m_n, 0.0), scale(m_n, 0.0);
    for (std::size_t l = 0; l < count; ++l) {
      const std::span<const double> load = loads.subspan(l * nodes, nodes);
      double size = 0;
      for (const double f : load) size = std::max(size, std::fabs(f));
      if (!(size > 0)) continue;
      const double factor = next_sign() / size;
      for (std::size_t i = 0; i < nodes; ++i)
        if (!(m_k.held[i / 3] >> (i % 3) & 1)) force[i] += factor * load[i];
      add_column(fields.subspan(l * m_n, m_n), factor, expected, scale);
    }
    return compare(force, expected, scale);
  }

 private:
  struct Range {
    std::size_t from, to;
  };
  bool symmetric(Range rows, Range columns) const {
    for (std::size_t j = columns.from; j < columns.to; ++j)
      for (std::size_t i = rows.from; i < rows.to; ++i)
        if (std::fabs(at(i, j) - at(j, i)) > kRounding * std::sqrt(at(i, i) * at(j, j))) return false;
    return true;
  }
  double at(std::size_t i, std::size_t j) const { return double(m_columns[j * m_n + i]); }
  std::size_t unknown(std::size_t i) const { return 3 * std::size_t(m_kept[i / 3]) + i % 3; }
  bool is_held(std::size_t i) const { return m_k.held[std::size_t(m_kept[i / 3])] >> (i % 3) & 1; }
  double next_sign() { return m_random.next() & 1 ? 1.0 : -1.0; }

  static void add_column(std::span<const float> column, double factor, std::vector<double>& sum,
                         std::vector<double>& scale) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += factor * double(column[i]);
      scale[i] += std::fabs(factor * double(column[i]));
    }
  }

  std::string compare(const std::vector<double>& force, const std::vector<double>& expected,
                      const std::vector<double>& scale) {
    const std::vector<double>* moved = m_solver.solve(force, kSolved, 4 * int(force.size()) + 100);
    if (!moved) return tr("it could not be compared with a solution");
    for (std::size_t i = 0; i < m_n; ++i)
      if (!(std::fabs((*moved)[unknown(i)] - expected[i]) <= kAgrees * scale[i]) && !is_held(i))
        return tr("it is not the compliance of this body");
    return {};
  }

  const Stiffness& m_k;
  std::span<const int> m_kept;
  std::span<const float> m_columns;
  std::size_t m_n;
  StiffnessSolver m_solver;
  core::Random m_random{0};
};

}  // namespace

std::string fault_of_compliance(const Stiffness& k, std::span<const int> kept, std::span<const double> loads,
                                std::span<const float> columns, std::span<const float> fields) {
  if (!all_finite(columns) || !all_finite(fields)) return tr("it holds figures that are not finite");
  Check check(k, kept, columns);
  std::string fault = check.matrix();
  if (fault.empty()) fault = check.forces();
  if (fault.empty() && !loads.empty()) fault = check.fields(loads, fields);
  return fault;
}

}  // namespace trocar::tissue
