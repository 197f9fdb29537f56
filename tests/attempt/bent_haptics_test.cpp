// What a hand feels of a bent instrument.
#include <gtest/gtest.h>

#include <trocar/attempt/haptics/contact_modeller.hpp>

#include "../sim/bent_scene.hpp"

namespace trocar::attempt {
namespace {

using small::Bent;
using small::kGrasper;
using small::kScissors;

TEST(BentHaptics, AnotherInstrumentAtALinkIsAPlaneForBothHandsAndAtAStraightOneNone) {
  for (const int hand : {kGrasper, kScissors}) {
    Bent b(0.001);
    ContactModeller modeller(b.model, hand);
    const Vec3d wanted = sim::led_place(b.model, b.state, size_t(hand));
    const devices::LocalModel felt = modeller.of(b.state, wanted, 0);
    ASSERT_EQ(felt.planes, 1) << hand;
    const double towards = dot(felt.plane[0].normal, b.beside());
    EXPECT_GT(hand == kGrasper ? -towards : towards, 0.3) << "away from the other";
    b.straighten();
    EXPECT_EQ(modeller.of(b.state, wanted, 0).planes, 0) << hand;
  }
}

TEST(BentHaptics, OfARedundantInstrumentThePlaceThatIsLedIsItsOwnTip) {
  const sim::Model model = small::bending(true);
  sim::State state = sim::initial_state(model);
  state.joints[kGrasper].angle[0] = 0.6;
  EXPECT_LT(length(sim::led_place(model, state, kGrasper) - sim::tip_frame_of(model, state, kGrasper).tip), 1e-15);
  const Bent wrist;
  EXPECT_GT(length(sim::led_place(wrist.model, wrist.state, kGrasper) -
                   sim::tip_frame_of(wrist.model, wrist.state, kGrasper).tip),
            0.01)
      << "a hand-held one's straight tip is led";
}

}  // namespace
}  // namespace trocar::attempt
