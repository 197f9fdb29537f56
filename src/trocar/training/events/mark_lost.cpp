#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

/// What was found once and is not in view any more.
class MarkLost final : public EventDetector {
 public:
  MarkLost(const sim::Model& model, const Arguments& a)
      : m_mark(a[0].index), m_found(a[1].number()), m_held(a[2].number()), m_lasting(a[3].number()) {
    m_off_centre = kMarkOffCentre.watch(model, {a[0]});
  }
  void sample(const Snapshot& snapshot, double dt, EventInstances& out) override {
    const Value off = m_off_centre->value(snapshot);
    if (off.known) {
      m_gone = 0;
      m_in_middle = off.number <= m_found ? m_in_middle + dt : 0;
      m_had = m_had || m_in_middle >= m_held;
      return;
    }
    m_gone += dt;
    m_in_middle = 0;
    if (!m_had || m_gone < m_lasting) return;
    m_had = false;
    const Vec3d at = place_of_mark(snapshot.model, snapshot.state, m_mark);
    out.add({-1, kNoBody, -1, &snapshot.model.targets[size_t(m_mark)].name, at, at});
  }

 private:
  std::int32_t m_mark;
  double m_found, m_held, m_lasting;
  std::unique_ptr<Observer> m_off_centre;
  double m_in_middle = 0, m_gone = 0;  ///< for how long it has been there, and not in view [s]
  bool m_had = false;                  ///< it was found since it was lost the last time
};

}  // namespace

const EventKind kMarkLost{
    "mark_lost",
    {{"of", ArgumentKind::mark, "the mark to look for"},
     {"found", ArgumentKind::number,
      "it counts as found within this distance of the picture's centre, as a share of the picture's radius", true, 0,
      1},
     {"held_s", ArgumentKind::number, "and after this time there", true, 0, 60},
     {"lasting_s", ArgumentKind::number, "it counts as lost after this time out of view", true, 0, 60}},
    {},
    "A mark that had been found is no longer in view; reported once until it is found again.",
    anywhere,
    &make_detector<MarkLost>};

}  // namespace trocar::training
