#include <array>

#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Where a hand's jaws shall take a strand: at a place, at another one after each failure.
double place_at_try(const sim::Model& model, const Given& given, int tries) {
  constexpr double kElsewhere[] = {0, 0.12, -0.08, 0.20};  // of the stretch
  if (given("at_mm").given) return given("at_mm").number();
  const Stretch between = stretch_of(model, given("of").index, given("after").word, given("before").word);
  const double share = given.number("share", 0.5) + kElsewhere[tries % 4];
  return between.from + (between.to - between.from) * share;
}

/// Through the open to before the tissue, jaws open and turned across it, the camera on the tip.
class Approach final : public Skill {
 public:
  Approach(const sim::Model& model, const Given& given) : m_hand(given.hand()), m_strand(given("of").index) {
    for (int t = 0; t < 4; ++t) m_places[size_t(t)] = place_at_try(model, given, t);
    m_share = given.number("inside_share", 0.6);
  }

 private:
  void start(Operator& op, int tries) override {
    op.posture(m_hand).end();
    m_s = m_places[size_t(tries % 4)];
  }
  Progress work(Operator& op) override {
    Operator::Target& target = op.target(m_hand);
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

/// From there until the tissue lies between the jaws.
class Enter final : public Skill {
 public:
  Enter(const sim::Model&, const Given& given) : m_hand(given.hand()) {}

 private:
  Progress work(Operator& op) override {
    const Operator::Target& t = op.target(m_hand);
    if (t.strand < 0) return fail("the hand was sent nowhere: approach first");
    op.want(op.point(t.strand, t.s));
    op.want(op.arm(m_hand).tip);
    const bool there = op.aim_at(m_hand, t.strand, t.s, t.inside, 0, pace::kCareful);
    return there ? Progress::done : Progress::working;
  }
  int m_hand;
};

/// Closes until the jaws hold the strand.
class Grasp final : public Skill {
 public:
  Grasp(const sim::Model& model, const Given& given) : m_hand(given.hand()) {
    m_beyond = given("of").given ? stretch_of(model, given("of").index, given("after").word, "").from : -1;
    m_closed = given.number("to", 0.95);
  }

 private:
  Progress work(Operator& op) override {
    const Operator::Target& t = op.target(m_hand);
    if (t.strand < 0) return fail("the hand was sent nowhere: approach first");
    op.want(op.point(t.strand, t.s));
    if (!op.arms().grip(m_hand, m_closed, 0.8) || m_in_phase < 1.2) return Progress::working;
    const double at = held_arc(op.model(), op.state(), size_t(m_hand), t.strand);
    if (at < 0 || at <= m_beyond) return fail("the jaws have not taken it");
    return Progress::done;
  }
  int m_hand;
  double m_beyond = -1, m_closed = 0.95;
};

/// A handle that closes wherever the jaws are.
class Close final : public Skill {
 public:
  Close(const sim::Model&, const Given& given)
      : m_hand(given.hand()), m_to(given.number("to", 1)), m_time(given.number("in_s", 1)) {}

 private:
  Progress work(Operator& op) override {
    op.want(op.arm(m_hand).tip);
    return op.arms().grip(m_hand, m_to, m_time) ? Progress::done : Progress::working;
  }
  int m_hand;
  double m_to, m_time;
};

/// Opens, and holds nothing up any more.
class LetGo final : public Skill {
 public:
  LetGo(const sim::Model&, const Given& given) : m_hand(given.hand()) {}

 private:
  Progress work(Operator& op) override {
    op.posture(m_hand).end();
    op.want(op.arm(m_hand).tip);
    return op.arms().grip(m_hand, 0, 0.4) ? Progress::done : Progress::working;
  }
  int m_hand;
};

std::string lacks_place(const sim::Model& model, const Given& given) { return Place::lacks(model, given); }

std::vector<Parameter> on_strand(bool needed) {
  return {hand_parameter(),
          {"of", ArgumentKind::strand, "the strand", needed},
          {"at_mm", ArgumentKind::number, "where, from its beginning", false, 0, 1000},
          {"after", ArgumentKind::landmark, "or: a landmark behind whose end the stretch begins", false},
          {"before", ArgumentKind::landmark, "and one before whose beginning it ends", false},
          {"share", ArgumentKind::number, "of that stretch; somewhere else near it after each failure", false, 0, 1}};
}

}  // namespace

const SkillKind kApproach{
    "approach",
    "approach the tissue",
    on_strand(true) +
        std::vector<Parameter>{number_parameter(
            "inside_share", "of the jaws' length: how far from their hinge the strand shall lie; 0.6", 0, 1)},
    15,
    "Goes through the open to before a place of a strand, jaws open and across it; the camera first.",
    lacks_place,
    &making<Approach>};
const SkillKind kEnter{"enter",
                       "take the tissue between the jaws",
                       {hand_parameter()},
                       8,
                       "Goes on from where it was sent until the strand lies between the jaws.",
                       nothing,
                       &making<Enter>};
const SkillKind kGrasp{"grasp",
                       "grasp",
                       {hand_parameter(),
                        {"of", ArgumentKind::strand, "what has to be held", false},
                        {"after", ArgumentKind::landmark, "beyond the end of this landmark of it", false},
                        number_parameter("to", "how far the handle closes; 0.95", 0, 1)},
                       4,
                       "Closes the jaws and feels whether they hold the strand.",
                       lacks_place,
                       &making<Grasp>};
const SkillKind kClose{"close",
                       "close the jaws",
                       {hand_parameter(), number_parameter("to", "how far; 1", 0, 1),
                        number_parameter("in_s", "from open to closed; 1", 0.05, 60)},
                       20,
                       "Closes the handle where the jaws are.",
                       nothing,
                       &making<Close>};
const SkillKind kLetGo{"let_go", "let go", {hand_parameter()}, 4, "Opens the jaws.", nothing, &making<LetGo>};

}  // namespace trocar::training
