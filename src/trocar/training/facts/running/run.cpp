// Running a gut hand over hand: how far it has gone without a gap, how often the place was lost, and how often jaws
// took it.
#include <algorithm>
#include <array>

#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/stations.hpp>

namespace trocar::training {
namespace {

constexpr double kBegins = 0.025;  // [m] the run begins with a hold as near to the first station's end as this
constexpr double kAgain = 0.035;   // [m] and continues, once it was lost, with one as near to where it had come to
constexpr double kFollows = 0.02;  // [m] a hold within this of the front is the one that keeps the place

/// Continues from hold to hold: the next one is taken while the last one still holds, not further on than one step.
class Run : public Observer {
 public:
  Run(const sim::Model& model, const Arguments& a)
      : m_stations(model, a[0].marks, a[1].number()), m_step(a[2].number()), m_hands(model.hands.size()) {
    m_held.fill(-1);
  }
  void sample(const Snapshot& snapshot, double) override {
    std::array<double, sim::kMaxTools> before = m_held;
    for (size_t h = 0; h < m_hands; ++h) {
      m_held[h] = m_stations.held_at(snapshot.model, snapshot.state, h);
      m_grasps += m_held[h] >= 0 && before[h] < 0;
    }
    if (!m_on) return begin();
    if (!anybody()) {
      m_on = false;
      ++m_lost;
      return;
    }
    if (keeps_place()) advance();
  }

 protected:
  double reached() const { return std::max(m_front, 0.0); }
  int lost() const { return m_lost; }
  int grasps() const { return m_grasps; }

 private:
  bool anybody() const {
    return std::any_of(m_held.begin(), m_held.begin() + std::ptrdiff_t(m_hands), [](double s) { return s >= 0; });
  }
  /// The hand that took the front still holds, though its grip may have shifted, or another one holds there.
  bool keeps_place() const {
    if (m_held[m_keeper] >= 0) return true;
    return std::any_of(m_held.begin(), m_held.begin() + std::ptrdiff_t(m_hands),
                       [this](double s) { return s >= 0 && s > m_front - kFollows && s < m_front + kFollows; });
  }
  /// From the beginning, or from where it was lost.
  void begin() {
    for (size_t h = 0; h < m_hands; ++h) {
      const double s = m_held[h];
      if (s < 0 || (m_front < 0 ? s > kBegins : s > m_front + kAgain || s < m_front - kAgain)) continue;
      m_on = true;
      m_front = std::max(m_front, s);
      m_keeper = h;
    }
  }
  void advance() {
    const double within = m_front + m_step;
    for (size_t h = 0; h < m_hands; ++h) {
      if (m_held[h] <= m_front || m_held[h] > within) continue;
      m_front = m_held[h];
      m_keeper = h;
    }
  }

  Stations m_stations;
  double m_step;
  size_t m_hands;
  std::array<double, sim::kMaxTools> m_held{};  ///< (hands) [m]; -1: not
  double m_front = -1;                          ///< [m]; -1: it has not begun
  size_t m_keeper = 0;                          ///< the hand that took it there
  bool m_on = false;
  int m_lost = 0, m_grasps = 0;
};

class Reached final : public Run {
 public:
  using Run::Run;
  Value value(const Snapshot&) const override { return reached(); }
};
class Lost final : public Run {
 public:
  using Run::Run;
  Value value(const Snapshot&) const override { return double(lost()); }
};
class Grasps final : public Run {
 public:
  using Run::Run;
  Value value(const Snapshot&) const override { return double(grasps()); }
};

class HeldAlong final : public Observer {
 public:
  HeldAlong(const sim::Model& model, const Arguments& a)
      : m_hand(size_t(a[0].index)), m_stations(model, a[1].marks, a[2].number()) {}
  Value value(const Snapshot& snapshot) const override {
    const double s = m_stations.held_at(snapshot.model, snapshot.state, m_hand);
    return s >= 0 ? Value(s) : kUnknown;
  }

 private:
  size_t m_hand;
  Stations m_stations;
};

std::vector<Parameter> run_parameters() {
  return {{"stations", ArgumentKind::marks, "discs on its wall, in their order along it"},
          {"spacing_mm", ArgumentKind::number, "distance from one to the next, and from the start to the first"},
          {"step_mm", ArgumentKind::number, "longest step from one grasp to the next"}};
}
std::string refuses_run(const sim::Model& model, const Arguments& a) { return no_stations(model, a[0].marks); }
std::string refuses_held(const sim::Model& model, const Arguments& a) { return no_stations(model, a[1].marks); }

}  // namespace

const Fact kRunReached{
    "run.reached_mm",
    run_parameters(),
    0,
    100'000,
    "Length of bowel that has been run hand over hand from its start: from a grasp within 25 mm of the "
    "first station on, with each next grasp taken while the last one still holds. After both hands have "
    "released, it continues from a grasp within 35 mm of the last position.",
    anywhere,
    &remembering<Reached>,
    false,
    &refuses_run};
const Fact kRunLost{"run.lost",
                    run_parameters(),
                    0,
                    1e6,
                    "Number of times that both hands released the bowel after the run had begun.",
                    anywhere,
                    &remembering<Lost>,
                    false,
                    &refuses_run};
const Fact kRunGrasps{
    "run.grasps", run_parameters(),     0,     1e6,         "Number of grasps of the bowel, all hands together.",
    anywhere,     &remembering<Grasps>, false, &refuses_run};
const Fact kHandHeldAlong{"hand.held_along_mm",
                          {{"hand", ArgumentKind::hand, "whose jaws"},
                           {"stations", ArgumentKind::marks, "discs on the gut's wall, in their order along it"},
                           {"spacing_mm", ArgumentKind::number, "from one to the next"}},
                          0,
                          100'000,
                          "Position of the jaws along the bowel. Unknown while they do not hold it.",
                          anywhere,
                          &remembering<HeldAlong>,
                          false,
                          &refuses_held};

}  // namespace trocar::training
