// How far both solvers of an organ are apart under the same hands: over time, and where they are farthest apart.
//
//   SolverComparison c(dynamic, at_once, organ);
//   ... a tick of each ...  c.after_tick(state, other_state, settled);
//   c.summary()
//
// Shares are of the indentation: how far the organ's farthest vertex is from where it lay at the beginning, as the
// dynamic solver has it.
#pragma once

#include <functional>

#include <trocar/attempt/press.hpp>
#include <trocar/attempt/solver_beside.hpp>

namespace trocar::attempt {

inline constexpr std::uint64_t kSampleTicks = 10;
inline constexpr double kLeastIndentation = 1e-4;  ///< below it there are no shares [m]

struct SolverSample {
  double seconds = 0;
  double moved = 0;             ///< the indentation [m]
  double rms = 0, largest = 0;  ///< distance between both skins, over their vertices [m]
  int vertex = 0;               ///< of the drawn skin, where it is largest
  double dynamic_force = 0;     ///< of all instruments' amounts, mean over the sample's ticks [N]
  double static_force = 0;
  bool settled = false;

  double share(double distance) const;  ///< [-]; NaN without an indentation
  double force_share() const;           ///< static over dynamic, less 1; NaN without a force
};

struct SolverSummary {
  SolverSample worst;           ///< of all, by largest distance
  SolverSample held;            ///< the last that is settled; else the one with the deepest indentation
  double deepest = 0;           ///< indentation [m]
  double rms = 0, largest = 0;  ///< over time: of all distances, of all [m]
};

class SolverComparison {
 public:
  /// Both must outlive it. @param organ  in both
  SolverComparison(const sim::Model& dynamic, const sim::Model& at_once, int organ);

  void after_tick(const sim::State& dynamic, const sim::State& at_once, bool settled);

  const std::vector<SolverSample>& samples() const { return m_samples; }
  SolverSummary summary() const;
  /// At the worst sample. @pre there is a sample
  const sim::State& dynamic_state() const { return m_dynamic_then; }
  const sim::State& static_state() const { return m_static_then; }

 private:
  void sample(const sim::State& dynamic, const sim::State& at_once, bool settled);

  OrganSkin m_dynamic, m_static;
  std::vector<Vec3f> m_begin;  ///< (vertices) of the dynamic one [m]
  std::vector<SolverSample> m_samples;
  sim::State m_dynamic_then, m_static_then;
  double m_worst = -1;
  double m_forces[2]{};  ///< sums since the last sample [N]
  int m_ticks = 0;
};

/// Both solvers of an organ: the exercise twice.
struct SolverPair {
  std::unique_ptr<Lesson> dynamic, at_once;
  int organ = -1;
};
/// @throws core::BadInput, also where the organ cannot have a static solver
SolverPair load_pair(const std::string& exercise, std::uint64_t seed, const std::string& organ);

/// Runs both under the hands of `source`, which sees the dynamic one, until it has no more, `seconds` have gone by
/// (0: no limit), or somebody interrupts.
/// @param settled  asked after every tick; may be empty
SolverComparison compare_solvers(const SolverPair& pair, InputSource& source, double seconds,
                                 const std::function<bool()>& settled = {});

}  // namespace trocar::attempt
