#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A closed instrument pushes what lies there aside.
class Sweep final : public Skill {
 public:
  Sweep(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()), m_place(model, args), m_way(args.number("by_mm", 0.02)) {
    const std::string& where = args("towards").word;
    m_direction = where == "up" ? Vec3d{0, 0, 1} : where == "head" ? Vec3d{0, 1, 0} : Vec3d{0, -1, 0};
    m_sideways = where == "outwards" ? 1 : where == "inwards" ? -1 : 0;
  }

 private:
  enum Phase { kReach, kPush };

  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(arm.tip);
    if (m_phase == kReach) {
      const Vec3d at = m_place.point(op, m_hand);
      op.want(at);
      const bool closed = op.arms().grip(m_hand, 1, 0.6);
      m_to = at + m_way * (m_sideways != 0 ? Vec3d{at.x > 0 ? m_sideways : -m_sideways, 0, 0} : m_direction);
      if (op.arms().move(m_hand, at, pace::kCareful) && closed) go(kPush);
      return Progress::working;
    }
    op.want(m_to);
    return op.arms().move(m_hand, m_to, pace::kCareful) ? Progress::done : Progress::working;
  }

  int m_hand;
  Place m_place;
  double m_way, m_sideways = 0;
  Vec3d m_direction, m_to;
};

}  // namespace

const SkillKind kSweep{
    "sweep",
    "push it aside",
    std::vector<Parameter>{hand_parameter("the hand whose closed instrument pushes"),
                           number_parameter("by_mm", "distance; default 20", 0, 200),
                           word_parameter("towards", "direction in the patient; default away from the patient's middle",
                                          {"outwards", "inwards", "up", "head", "feet"})} +
        place_parameters(),
    30,
    "Pushes tissue at a place aside with closed jaws, and stays there.",
    Place::lacks,
    &making<Sweep>};

}  // namespace trocar::training
