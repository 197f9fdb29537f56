#include <array>
#include <optional>

#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Where a hand's jaws shall take a strand: at a place, at another one after each failure.
double place_at_try(const sim::Model& model, const SkillArgs& args, int tries) {
  constexpr double kElsewhere[] = {0, 0.12, -0.08, 0.20};  // of the stretch
  if (const std::optional<double> arc = arc_given(model, args)) return *arc;
  const Stretch between = stretch_of(model, args("of").index, args("after").word, args("before").word);
  const double share = args.number("share", 0.5) + kElsewhere[tries % 4];
  return between.from + (between.to - between.from) * share;
}

/// Through the open to before the tissue, jaws open and turned across it, the camera on the tip.
class Approach final : public Skill {
 public:
  Approach(const sim::Model& model, const SkillArgs& args) : m_hand(args.hand()), m_strand(args("of").index) {
    for (int t = 0; t < 4; ++t) m_places[size_t(t)] = place_at_try(model, args, t);
    m_share = args.number("inside_share", 0.6);
  }

 private:
  void start(Surgeon& op, int tries) override {
    op.posture(m_hand).end();
    m_s = m_places[size_t(tries % 4)];
  }
  Progress work(Surgeon& op) override {
    Surgeon::Target& target = op.target(m_hand);
    target = {m_strand, m_s, m_share * op.tool(m_hand).jaw_length};
    op.want(op.point(m_strand, m_s));
    op.make_room(m_hand);
    const bool open = op.arms().grip(m_hand, 0, 0.5);
    const bool there = op.approach(m_hand, m_strand, m_s, target.inside, m_in_phase);
    return there && open ? Progress::done : Progress::working;
  }
  int m_hand, m_strand;
  double m_share, m_s = 0;
  std::array<double, 4> m_places{};
};

std::vector<Parameter> on_strand() {
  return {hand_parameter(),
          {"of", ArgumentKind::strand, "the rod"},
          {"at_mm", ArgumentKind::number, "distance from its beginning", false, 0, 1000},
          from_end_parameter(),
          {"after", ArgumentKind::landmark, "or: landmark at whose end the stretch begins", false},
          {"before", ArgumentKind::landmark, "and landmark at whose beginning it ends", false},
          {"share", ArgumentKind::number, "share of that stretch; another near it after each failure", false, 0, 1}};
}

}  // namespace

const SkillKind kApproach{
    "approach",
    "approach the tissue",
    on_strand() +
        std::vector<Parameter>{number_parameter(
            "inside_share", "distance of the rod from the hinge, as a share of the jaws' length; default 0.6", 0, 1)},
    15,
    "Moves the open jaws to a place of a rod, across it; the camera moves first.",
    Place::lacks,
    &making<Approach>};

}  // namespace trocar::training
