// How far the hepatocystic triangle is open: as drawn, as somebody moves its corners, and once a duct is cut.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

struct Ducts {
  sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy/scene.json"));
  sim::State state = sim::initial_state(model);
  int cystic = model.strand_index("cystic_duct"), common = model.strand_index("common_duct");

  Value of(const Fact& fact) const {
    const Arguments both{{true, cystic, 0, 0, "", {}}, {true, common, 0, 0, "", {}}};
    return fact.watch(model, both)->value({model, state});
  }
  double degrees() const { return of(kTriangleAngle).number * 180 / portable::pi; }
  std::vector<Vec3d>& duct() { return state.strands[std::size_t(cystic)].x; }
};

}  // namespace

TEST(Traction, AsDrawnTheTriangleIsThatOfAnAdultWhoseInfundibulumIsHeldAside) {
  const Ducts d;
  EXPECT_NEAR(d.degrees(), 71, 4) << "58 degrees where nobody draws [c]";
  EXPECT_NEAR(d.of(kTriangleArea).number * 1e6, 350, 40);
}

TEST(Traction, ItsAngleAndAreaAreThoseOfItsCorners) {
  Ducts d;
  const Vec3d junction = d.duct().front();
  const double before = d.degrees(), area = d.of(kTriangleArea).number;
  for (Vec3d& p : d.duct()) p = junction + 2.0 * (p - junction);
  EXPECT_NEAR(d.degrees(), before, 1e-9) << "twice as long, the same way";
  EXPECT_NEAR(d.of(kTriangleArea).number, 2 * area, 1e-9);
  const std::vector<Vec3d>& common = d.state.strands[std::size_t(d.common)].x;
  for (Vec3d& p : d.duct()) p = junction + 0.02 * normalised(common.front() - junction);
  d.duct().front() = junction;
  EXPECT_LT(d.degrees(), 20) << "beside the hepatic duct: it has collapsed";
}

TEST(Traction, OfADuctThatIsSeveredThereIsNoTriangle) {
  Ducts d;
  d.state.strands[std::size_t(d.cystic)].alive[4] = 0;
  EXPECT_FALSE(d.of(kTriangleAngle).known);
  EXPECT_FALSE(d.of(kTriangleArea).known);
}

}  // namespace trocar::training
