#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/following.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

class Followed final : public Observer {
 public:
  Followed(const sim::Model& model, const Arguments& a)
      : m_following({a[1].number(), a[2].number(), a[3].number(), a[4].number(), a[5].number()}, model, a[0].index) {}
  void sample(const Look& look, double dt) override {
    std::array<Vec3d, sim::kMaxTools> tips{};
    for (size_t h = 0; h < hands(look.model); ++h) tips[h] = tip_of(look.model, look.state, h);
    m_following.update(look.model, look.state, {tips.data(), hands(look.model)}, dt);
  }
  Value value(const Look&) const override { return m_following.done(); }

 private:
  Following m_following;
};

std::string no_fimbriae(const sim::Model& model, const Arguments& a) {
  const auto& strand = model.strands[size_t(a[0].index)];
  for (const sim::LandmarkModel& l : strand.landmarks)
    if (l.name == "fimbria") return "";
  return "expected a strand with a landmark \"fimbria\", got \"" + strand.name + "\", which has none";
}

}  // namespace

const Fact kStrandFollowed{
    "strand.followed",
    {{"of", ArgumentKind::strand, "a tube with a landmark \"fimbria\""},
     {"to_mm", ArgumentKind::number, "from its beginning: up to where"},
     {"speed_mm_s", ArgumentKind::number, "at most", true, 1, 1000},
     {"gap_mm", ArgumentKind::number, "a covered stretch that may be skipped"},
     {"pause_s", ArgumentKind::number, "lost longer than this, it starts over"},
     {"touch_mm", ArgumentKind::number, "an instrument's tip this near follows as well as the eye"}},
    0,
    1,
    "It has been followed from its fimbriae back to there, with the eye or an instrument's tip.",
    anywhere,
    &remembering<Followed>,
    true,
    no_fimbriae};

}  // namespace trocar::training
