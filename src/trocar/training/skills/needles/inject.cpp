// What a hand does with an injection needle: to a place of an organ and in, to a depth; draw the plunger; press it.
#include <algorithm>

#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

const sim::NeedleHand& needle_in(const Surgeon& op, int hand) { return op.state().injection.hands[size_t(hand)]; }

/// The skin's vertex that was drawn nearest to a place.
int vertex_near(const tissue::Skin& skin, Vec3d place) {
  int best = -1;
  double least = 1e30;
  for (int v = 0; v < skin.size(); ++v) {
    const Vec3d off = vec_cast<double>(skin.rest[size_t(v)]) - place;
    if (dot(off, off) >= least || !skin.at_surface(v)) continue;
    least = dot(off, off);
    best = v;
  }
  return best;
}

/// To before a place of an organ, then along the shaft through its skin, and as deep as it shall be.
class Pierce final : public Skill {
 public:
  Pierce(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()), m_organ(args("of").body()), m_depth(args.number("depth_mm", 0.003)) {
    const Vec3d at{args.number("x_mm", 0), args.number("y_mm", 0), args.number("z_mm", 0)};
    m_vertex = vertex_near(model.solids[m_organ.index()].skin, at);
  }

 private:
  enum Phase { kReach, kOut, kIn, kSettle };
  static constexpr double kBefore = 0.012;  // [m] of the point from the skin

  void start(Surgeon& op, int tries) override {
    Skill::start(op, tries);
    m_still = 0;
    if (needle_in(op, m_hand).in()) go(kSettle);
  }

  Vec3d place(const Surgeon& op) const {
    return tissue::skin_point(sim::nodes_of(op.model(), op.state(), int(m_organ.index())),
                              op.model().solids[m_organ.index()].skin, m_vertex);
  }

  Progress work(Surgeon& op) override {
    constexpr double kLongest = 20, kPush = 0.006, kSlow = 0.003, kNearly = 0.0004, kRest = 0.4;  // [s] [m/s] [m] [s]
    Arms::Arm& arm = op.arm(m_hand);
    const sim::NeedleHand& needle = needle_in(op, m_hand);
    const Vec3d at = place(op), in = normalised(at - arm.port);
    const double length = op.tool(m_hand).needle.length;
    op.want(at);
    op.want(at - (length + kBefore) * in);
    switch (m_phase) {
      case kReach:
        op.arms().grip(m_hand, 1, 0.5);  // drawn in on the way
        if (op.arms().move(m_hand, at - (length + kBefore) * in, pace::kTravel)) go(kOut);
        return m_in_phase > kLongest ? fail("did not reach the position in front of it") : Progress::working;
      case kOut:
        if (op.arms().grip(m_hand, 0, 0.5)) go(kIn);
        return Progress::working;
      case kIn:
        arm.tip += kPush * sim::kTick * in;
        arm.moving = true;
        if (needle.in()) go(kSettle);
        return m_in_phase > kLongest ? fail("the needle did not enter") : Progress::working;
      default: {
        if (!needle.in()) {
          go(kIn);
          return Progress::working;
        }
        const double off = m_depth - needle.depth;
        const bool there = std::max(off, -off) < kNearly;
        m_still = there ? m_still + sim::kTick : 0;
        if (!there) {
          arm.tip += std::clamp(4 * off, -kSlow, kSlow) * sim::kTick * normalised(arm.tip - arm.port);
          arm.moving = true;
        }
        if (m_still > kRest) return Progress::done;
        return m_in_phase > kLongest ? fail("the needle did not reach the depth") : Progress::working;
      }
    }
  }

  int m_hand;
  BodyId m_organ;
  double m_depth;
  int m_vertex = -1;
  double m_still = 0;
};

/// The plunger is drawn: does blood come?
class Aspirate final : public Skill {
 public:
  Aspirate(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()), m_for(args.number("for_s", 1.5)) {}

 private:
  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(needle_in(op, m_hand).at);
    arm.sucking = m_in_phase < m_for;
    if (needle_in(op, m_hand).blood > fluids::kMillilitre / 20) {
      arm.sucking = false;
      return fail("blood comes");
    }
    return arm.sucking ? Progress::working : Progress::done;
  }
  int m_hand;
  double m_for;
};

/// The plunger is pressed until so much has flowed, or nothing is left.
class Inject final : public Skill {
 public:
  Inject(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()), m_volume(args.number("volume_mL", 5e-6)) {}

 private:
  void start(Surgeon& op, int tries) override {
    Skill::start(op, tries);
    m_left = needle_in(op, m_hand).left;
  }
  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    const sim::NeedleHand& needle = needle_in(op, m_hand);
    op.want(needle.at);
    const bool enough = fluids::kM3PerPicolitre * double(m_left - needle.left) >= m_volume || needle.left == 0;
    arm.irrigating = !enough;
    return enough ? Progress::done : Progress::working;
  }
  int m_hand;
  double m_volume;
  std::int64_t m_left = 0;
};

/// Out of the tissue along the shaft, and the needle into it.
class DrawOut final : public Skill {
 public:
  DrawOut(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()) {}

 private:
  static constexpr double kBack = 0.03;  // [m]
  void start(Surgeon& op, int tries) override {
    Skill::start(op, tries);
    const Arms::Arm& arm = op.arm(m_hand);
    m_to = length(arm.tip - arm.port) - kBack;
    m_at = needle_in(op, m_hand).at;
  }
  Progress work(Surgeon& op) override {
    op.want(m_at);
    const bool back = op.arms().move_to_depth(m_hand, m_to, pace::kCareful);
    const bool in = needle_in(op, m_hand).in() || op.arms().grip(m_hand, 1, 0.5);
    return back && in ? Progress::done : Progress::working;
  }
  int m_hand;
  double m_to = 0;
  Vec3d m_at;
};

std::string lacks_injection_needle(const sim::Model& model, const SkillArgs& args) {
  return lacks_tool(model, args.hand(), &interactions::Abilities::inject);
}
std::string lacks_pierced_organ(const sim::Model& model, const SkillArgs& args) {
  const BodyId body = args("of").body();
  if (!body.is(BodyKind::organ) || body.index() >= model.injection.organs.size() ||
      !(model.injection.organs[body.index()].puncture > 0))
    return "the body is not an organ that a needle can enter";
  return lacks_injection_needle(model, args);
}

}  // namespace

const SkillKind kPierce{
    "pierce",
    "insert the needle",
    {hand_parameter("the hand with the needle"),
     {"of", ArgumentKind::body, "the organ"},
     number_parameter("x_mm", "place on its skin in the standard shape: the nearest to this point", -500, 500),
     number_parameter("y_mm", "the same", -500, 500),
     number_parameter("z_mm", "the same", -500, 500),
     number_parameter("depth_mm", "depth of the tip below the skin; default 3", 0.2, 20)},
    45,
    "Brings an injection needle to a place of an organ, extends it, presses it through the skin along its shaft, and "
    "corrects its depth.",
    lacks_pierced_organ,
    &making<Pierce>};
const SkillKind kAspirate{
    "aspirate",
    "draw the plunger",
    {hand_parameter("the hand with the needle"), number_parameter("for_s", "time; default 1.5", 0.1, 20)},
    25,
    "Draws the plunger to see whether blood comes; fails if it does.",
    lacks_injection_needle,
    &making<Aspirate>};
const SkillKind kInject{
    "inject",
    "inject",
    {hand_parameter("the hand with the needle"), number_parameter("volume_mL", "volume; default 5", 0.01, 100)},
    180,
    "Presses the plunger until the volume has left the needle.",
    lacks_injection_needle,
    &making<Inject>};
const SkillKind kDrawOut{"draw_out",
                         "draw the needle out",
                         {hand_parameter("the hand with the needle")},
                         20,
                         "Withdraws an instrument by 30 mm along its shaft, and retracts its needle.",
                         lacks_injection_needle,
                         &making<DrawOut>};

}  // namespace trocar::training
