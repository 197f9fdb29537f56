#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/following.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

class Followed final : public Observer {
 public:
  Followed(const sim::Model& model, const Arguments& a)
      : m_following({a[2].number(), a[3].number(), a[4].number(), a[5].number(), a[6].number()}, model, a[0].index,
                    a[1].word) {}
  void sample(const Moment& moment, double dt) override {
    std::array<Vec3d, sim::kMaxTools> tips{};
    for (size_t h = 0; h < hands(moment.model); ++h) tips[h] = tip_of(moment.model, moment.state, h);
    m_following.update(moment.model, moment.state, {tips.data(), hands(moment.model)}, dt);
  }
  Value value(const Moment&) const override { return m_following.done(); }

 private:
  Following m_following;
};

}  // namespace

const Fact kStrandFollowed{
    "strand.followed",
    {{"of", ArgumentKind::strand, "which"},
     {"from", ArgumentKind::landmark, "of it: where following begins, a tube's fimbriae"},
     {"to_mm", ArgumentKind::number, "from its beginning: up to where"},
     {"speed_mm_s", ArgumentKind::number, "at most", true, 1, 1000},
     {"gap_mm", ArgumentKind::number, "a covered stretch that may be skipped"},
     {"pause_s", ArgumentKind::number, "lost longer than this, it starts over"},
     {"touch_mm", ArgumentKind::number, "an instrument's tip this near follows as well as the eye"}},
    0,
    1,
    "It has been followed from that landmark back to there, with the eye or an instrument's tip.",
    anywhere,
    &remembering<Followed>,
    true};

}  // namespace trocar::training
