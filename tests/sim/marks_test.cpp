// Marks are seen like anything else: from the front, with nothing before them.
#include <gtest/gtest.h>

#include <trocar/sim/stages/visibility.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

/// The small scene with a disc 40 mm in front of the lens, in the middle of the picture, and a stripe around its tube.
struct Marked {
  Model model;
  State state;
  Work work;

  explicit Marked(double turned = 0, double aside = 0) : model(compiled(turned, aside)) {
    state = initial_state(model);
    work = make_work(model);
    for (size_t i = 0; i <= model.samples.size(); ++i) step(model, model.start, state, work);
  }
  static Model compiled(double turned, double aside) {
    const Model& plain = small::model();
    const kinematics::ScopeFrame scope = scope_of(plain, initial_state(plain));
    scene::Description d = small::description();
    const Vec3d at = scope.eye + 0.012 * scope.forward + aside * scope.right;
    d.marks.push_back({.name = "disc",
                       .on = "",
                       .place = at,
                       .normal = -std::cos(turned) * scope.forward + std::sin(turned) * scope.right,
                       .size = 0.004,
                       .label = "",
                       .colour = "white",
                       .look = "",
                       .at = {}});
    d.marks.push_back({.name = "stripe",
                       .on = "tube",
                       .stripe = true,
                       .place = {},
                       .normal = {},
                       .s = 0.030,
                       .size = 0.001,
                       .label = "",
                       .colour = "black",
                       .look = "",
                       .at = {}});
    return scene::compile(d);
  }
  double share(const char* name) const { return visible_share(model, state, model.target_index(name)); }
};

TEST(MarksInView, ADiscIsSeenFromTheFrontAndNotFromBehind) {
  EXPECT_EQ(Marked().share("disc"), 1);
  EXPECT_EQ(Marked(1.0).share("disc"), 1) << "aslant, too";
  EXPECT_EQ(Marked(2.0).share("disc"), 0) << "its back is not it";
}

TEST(MarksInView, ADiscAtThePicturesEdgeIsSeenInPart) {
  const double half = 0.5 * 0.97 * small::model().scope.field_of_view;
  const double share = Marked(0, 0.012 * std::tan(half)).share("disc");
  EXPECT_GT(share, 0);
  EXPECT_LT(share, 1);
}

TEST(MarksInView, AStripeIsSeenAsItsTubeIs) {
  Marked m;
  const kinematics::ScopeFrame scope = scope_of(m.model, m.state);
  const MarkModel& stripe = m.model.marks[1];
  const Vec3d at = mark_sample(m.model, m.state, stripe, 1, scope.eye), place = pose_of(m.model, m.state, stripe).place;
  EXPECT_NEAR(length(at - place), small::kTubeRadius, 1e-6) << "on the side towards the eye";
  EXPECT_LT(length(at - scope.eye), length(place - scope.eye));
  const bool free = unoccluded(m.model, m.state, m.work, scope.eye, at, 0.0015, -1, small::kTube);
  EXPECT_EQ(m.share("stripe") >= 0.5, free);
}

TEST(MarksInView, SamplesOfADiscLieWithinIt) {
  const Marked m;
  const MarkModel& disc = m.model.marks[0];
  const MarkPose pose = pose_of(m.model, m.state, disc);
  for (int k = 0; k < kDiscSamples; ++k) {
    const Vec3d off = mark_sample(m.model, m.state, disc, k, {}) - pose.place;
    EXPECT_NEAR(dot(off, pose.normal), 0, 1e-12);
    EXPECT_NEAR(length(off), k == 0 ? 0 : 0.7 * disc.half, 1e-12);
  }
}

}  // namespace
