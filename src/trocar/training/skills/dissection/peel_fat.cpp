#include <algorithm>

#include <trocar/training/observe/directions.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Jaws take fat beside where it still holds on a body, draw it off, and let it go.
class PeelFat final : public Skill {
 public:
  PeelFat(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_fat(args("fat").body().index()),
        m_off(args("off").body()),
        m_way(patient_direction(args("towards").word)),
        m_far(args.number("by_mm", 0.02)),
        m_speed(args.number("speed_mm_s", 0.005)),
        m_most(args.number("pull_N", 2)),
        m_tied(std::size_t(model.fat[m_fat].fat.lobules())) {}

 private:
  enum Phase { kReach, kEnter, kClose, kDraw, kOpen };
  static constexpr double kEnters = 0.004, kPressed = 0.8;  // [m] beyond what is taken; [N] that stops it
  static constexpr double kLongest[] = {8, 4, 2, 20, 3};    // [s]

  struct Hold {
    int lobule = -1;  ///< to be taken
    double near = 0;  ///< of the place where it holds to the trocar [m]
  };
  const interactions::FatBody& body(const Surgeon& op) const { return op.model().fat[m_fat]; }
  const tissue::FatState& state(const Surgeon& op) const { return op.state().fat[m_fat]; }
  Vec3d place(const Surgeon& op, int lobule) const { return position(body(op).fat, state(op), lobule); }

  /// Which lobules hold on the body itself.
  void note_tied(const Surgeon& op) {
    std::fill(m_tied.begin(), m_tied.end(), std::uint8_t(0));
    const std::size_t set = std::size_t(body(op).roots);
    const std::vector<interactions::Bond>& bonds = op.model().bonds[set].bonds;
    for (std::size_t i = 0; i < bonds.size(); ++i)
      if (op.state().bonds[set][i].holds() && bonds[i].far.body == m_off) m_tied[std::size_t(bonds[i].node())] = 1;
  }
  /// Of each such lobule the neighbour that does not: what is drawn to draw that off. Nearest to the trocar first.
  std::vector<Hold> holds(const Surgeon& op, Vec3d port) {
    note_tied(op);
    std::vector<Hold> found;
    const interactions::FatBody& b = body(op);
    for (int k = 0; k < b.fat.septa(); ++k) {
      if (!(holding(b.fat, state(op), k) > 0)) continue;
      int in = septum_end(b.fat, k, 0), out = septum_end(b.fat, k, 1);
      if (m_tied[std::size_t(out)]) std::swap(in, out);
      if (m_tied[std::size_t(in)] && !m_tied[std::size_t(out)]) found.push_back({out, length(place(op, in) - port)});
    }
    std::sort(found.begin(), found.end(), [](const Hold& a, const Hold& c) {
      return a.near < c.near || (!(c.near < a.near) && a.lobule < c.lobule);
    });
    return found;
  }

  /// After each failure another one.
  void start(Surgeon& op, int tries) override {
    constexpr std::size_t kApart = 5;
    const std::vector<Hold> all = holds(op, op.arm(m_hand).port);
    m_lobule = all.empty() ? -1 : all[std::size_t(tries) * kApart % all.size()].lobule;
    m_drawn = 0;
  }
  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    if (m_lobule < 0) return Progress::done;
    op.want(arm.tip);
    const bool late = m_in_phase > kLongest[m_phase];
    const Vec3d at = place(op, m_lobule), along = normalised(at - arm.port);
    switch (m_phase) {
      case kReach: {
        op.want(at);
        const bool open = op.arms().grip(m_hand, 0, 0.8);
        if ((op.arms().move(m_hand, at - reach::kBefore * along, pace::kTravel) && open) || late) go(kEnter);
        break;
      }
      case kEnter:
        op.want(at);
        if (op.arms().move(m_hand, at + kEnters * along, pace::kCareful) || late ||
            norm(op.tool_state(m_hand).contact_force) > kPressed)
          go(kClose);
        break;
      case kClose:
        if (op.arms().grip(m_hand, 0.95, 0.8) || late) m_from = arm.tip, go(kDraw);
        break;
      case kDraw:
        draw(op);
        break;
      default:
        if (op.arms().grip(m_hand, 0, 0.6) || late)
          return m_drawn > 0 ? Progress::done : fail("the jaws did not grasp it");
    }
    return Progress::working;
  }
  void draw(Surgeon& op) {
    if (op.tool_state(m_hand).holds == 0 || m_in_phase > kLongest[kDraw]) return go(kOpen);
    if (norm(op.tool_state(m_hand).pull) < m_most) m_drawn = std::min(m_drawn + m_speed * sim::kTick, m_far);
    if (op.arms().move(m_hand, m_from + m_drawn * m_way, pace::kCareful) && m_drawn >= m_far) go(kOpen);
  }

  int m_hand;
  std::size_t m_fat;
  BodyId m_off;
  Vec3d m_way, m_from;
  double m_far, m_speed, m_most, m_drawn = 0;
  int m_lobule = -1;
  std::vector<std::uint8_t> m_tied;  ///< (lobules)
};

std::string lacks_peeling(const sim::Model& model, const SkillArgs& args) {
  if (!args("fat").body().is(BodyKind::fat)) return "the body to peel is not fat";
  return lacks_tool(model, args.hand(), &interactions::Abilities::grip);
}

}  // namespace

const SkillKind kPeelFat{"peel_fat",
                         "peel fat off",
                         {hand_parameter("the hand with a grasper"),
                          {"fat", ArgumentKind::body, "the fat"},
                          {"off", ArgumentKind::body, "the body that it is attached to"},
                          word_parameter("towards", "direction in the patient", patient_directions()),
                          number_parameter("by_mm", "distance of the pull; default 20", 0, 200),
                          number_parameter("speed_mm_s", "highest speed; default 5", 0.1, 100),
                          number_parameter("pull_N", "waits while the pull is above this; default 2", 0, 50)},
                         40,
                         "Takes fat between the jaws beside its attachment to a body, draws it off, and releases it.",
                         lacks_peeling,
                         &making<PeelFat>};

}  // namespace trocar::training
