// Two clips on a tube, each in its place and as far apart as they should be. They may come in either order: a pair
// decides, and a clip alone counts for the place that it fits.
#pragma once

#include <array>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

class ClipPair {
 public:
  struct Span {
    double low = 0, high = 0;
    bool holds(double v) const { return v >= low && v <= high; }
  };
  /// SI. What a clip must be to count: across, closed slowly, in view, around the whole tube, on the stretch that may
  /// be clipped; and where the two belong.
  struct Limits {
    Span first, second, apart, stretch;
    double angle = 0, cover = 0, closing = 0;
  };

  ClipPair() = default;
  ClipPair(const Limits& limits, int strand) : m_limits(limits), m_strand(strand) {}

  /// Takes in the clips that have come since the last call.
  void update(const sim::State& state);
  /// One more clip; of other strands nothing is kept.
  void take(const interactions::Clip& clip);

  bool first_set() const { return m_first; }
  bool second_set() const { return m_second; }
  bool misplaced() const { return m_misplaced; }  ///< the last clip was well set, but where none belongs
  bool paired() const { return m_pair[0] >= 0 && m_pair[1] >= 0; }
  double apart() const { return m_pair[1] - m_pair[0]; }  ///< of the pair [m]

 private:
  bool well_set(const interactions::Clip& clip) const;
  bool are_a_pair(double inner, double outer) const;
  bool fits(double s) const { return m_limits.first.holds(s) || m_limits.second.holds(s); }
  bool place(double s, bool counts);

  Limits m_limits;
  int m_strand = -1;
  std::int32_t m_seen = 0;  ///< clips of the State
  std::array<double, interactions::kMaxClips> m_counting{};
  int m_count = 0;
  std::array<double, 2> m_pair{-1, -1};
  bool m_first = false, m_second = false, m_misplaced = false;
};

}  // namespace trocar::training
