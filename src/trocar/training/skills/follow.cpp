#include <algorithm>

#include <trocar/training/observe/following.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/sampling.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// With the eye from a landmark inwards; if the eye is not enough, with an instrument's tip.
class Follow final : public Skill {
 public:
  Follow(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_strand(args("of").index),
        m_from(model.target_index(model.strands[size_t(m_strand)].name + "." + args("from").word)),
        m_following({args("to_mm").number(), args.number("speed_mm_s", 0.03), args.number("gap_mm", 0.009),
                     args.number("pause_s", 1), args.number("touch_mm", 0.01)},
                    model, m_strand, args("from").word) {}

 private:
  Progress work(Surgeon& op) override {
    constexpr double kByHand = 9;  // [s] after which the instrument helps the eye
    std::array<Vec3d, sim::kMaxTools> tips{};
    for (int h = 0; h < op.arms().count(); ++h) tips[size_t(h)] = tip_of(op.model(), op.state(), size_t(h));
    if (op.state().tick % kSampleEvery == 0)
      m_following.update(op.model(), op.state(), {tips.data(), size_t(op.arms().count())}, kSample);
    if (m_following.done()) return Progress::done;
    const Vec3d front = m_following.begun() ? op.point(m_strand, m_following.reached()) : op.middle_of(m_from);
    op.want(front);
    if (m_following.begun()) op.want(op.point(m_strand, std::max(0.0, m_following.reached() - 0.015)));
    if (m_in_phase > 0.4 * kByHand) op.make_room(m_hand);
    if (m_in_phase < kByHand) return Progress::working;
    op.arms().grip(m_hand, 1, 0.6);
    op.want(op.arm(m_hand).tip);
    if (op.sees_tip(m_hand) || m_in_phase < kByHand + 1)
      op.arms().move(m_hand, front + Vec3d{0, 0, 0.0075}, 0.6 * pace::kTravel);
    return Progress::working;
  }

  int m_hand, m_strand, m_from;
  Following m_following;
};

std::string follow_lacks(const sim::Model& model, const SkillArgs& args) {
  return lacks_landmark(model, args("of").index, args("from").word);
}

}  // namespace

const SkillKind kFollow{"follow",
                        "follow the tube",
                        {hand_parameter("a hand whose tip helps where the view is not enough"),
                         {"of", ArgumentKind::strand, "the rod"},
                         {"from", ArgumentKind::landmark, "landmark where following begins, such as a tube's fimbriae"},
                         {"to_mm", ArgumentKind::number, "end of following, from the rod's beginning"},
                         {"speed_mm_s", ArgumentKind::number, "highest speed; default 30", false, 1, 1000},
                         {"gap_mm", ArgumentKind::number, "covered stretch that may be skipped; default 9", false},
                         {"pause_s", ArgumentKind::number, "restarts after this time without sight; default 1", false},
                         {"touch_mm", ArgumentKind::number, "a tip this near follows, too; default 10", false}},
                        30,
                        "Follows a rod from a landmark back to its beginning, with the camera or an instrument's tip.",
                        follow_lacks,
                        &making<Follow>};

}  // namespace trocar::training
