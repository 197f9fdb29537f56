// Blunt dissection of a gallbladder's bed: what tip and jaws of an instrument push apart comes apart, with the forces
// that hands use for it. Both begin with a closed tip that goes into the gap at the free edge, where wall and liver lie
// on each other.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kHand = 1;
constexpr Vec3d kEdge{-0.069, 0.121, -0.081};  ///< [m] of the bed, towards the neck
constexpr double kFrom = 0.025;                ///< [m] before the edge, where the instrument begins

Model bed_with(const char* instrument) {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder_bed/scene.json");
  d.placements[kHand].instrument = instrument;
  return scene::compile(d);
}

/// What a hand does: its tip somewhere, jaws as far closed.
class Work_ {
 public:
  explicit Work_(const char* instrument)
      : m_model(bed_with(instrument)), m_state(initial_state(m_model)), m_work(make_work(m_model)) {
    const interactions::BondSet& bed = m_model.bonds.at(0);
    for (const interactions::Bond& bond : bed.bonds)
      if (length(node(bond) - kEdge) < length(node(bed.bonds[m_first]) - kEdge))
        m_first = std::size_t(&bond - bed.bonds.data());
    const interactions::Bond& first = bed.bonds[m_first];
    m_apart = -normalised(first.hold.offset);
    m_port = m_model.hands[kHand].port;
    m_edge = node(first) - 0.5 * first.hold.offset;
    m_along = normalised(m_edge - m_port);
    m_roll = kinematics::roll_towards(kinematics::inverse(m_port, m_edge, 0), cross(m_along, m_apart));
    m_tip = m_edge - kFrom * m_along;
    hold(500);
  }
  Vec3d node(const interactions::Bond& bond) const {
    return position(m_model.membranes[0].sheet.network, m_state.membranes[0].network, bond.node);
  }
  void tick() {
    Input input = m_model.start;
    input.tools[kHand] = tool_input(kinematics::inverse(m_port, m_tip, m_roll), float(m_handle));
    ASSERT_TRUE(step(m_model, input, m_state, m_work).fine());
    m_wall = std::max(m_wall, press_on(BodyId::membrane(0)));
    m_liver = std::max(m_liver, press_on(BodyId::organ(std::size_t(m_model.organ_index("liver")))));
  }
  void hold(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  void go(Vec3d by, double speed) {
    const Vec3d from = m_tip;
    const int ticks = int(length(by) / speed / kTick);
    for (int i = 1; i <= ticks; ++i) m_tip = from + (double(i) / ticks) * by, tick();
  }
  /// Opens in two seconds as far as it goes with that force on either side.
  void spread(double most) {
    for (int i = 0; i < 2000; ++i) {
      if (std::max(press_on(BodyId::membrane(0)), press_on(BodyId::organ(std::size_t(m_model.organ_index("liver"))))) <
          most)
        m_handle = std::max(0.0, m_handle - 1.0 / 2000);
      tick();
    }
  }
  double share() const { return interactions::holding_share(m_model.bonds[0], m_state.bonds[0]); }
  int parted() const {
    return int(
        std::count_if(m_state.bonds[0].begin(), m_state.bonds[0].end(), [](const auto& b) { return !b.holds(); }));
  }
  double press_on(BodyId body) const {
    Vec3d sum;
    const interactions::TouchBook& book = m_state.touches[kHand];
    for (int i = 0; i < book.count; ++i)
      if (book.touch[i].body == body) sum += interactions::press_of(book.touch[i]);
    return length(sum);
  }
  void reset() { m_wall = m_liver = 0; }

  Model m_model;
  State m_state;
  Work m_work;
  std::size_t m_first = 0;
  Vec3d m_apart, m_port, m_edge, m_along, m_tip;
  double m_roll = 0, m_handle = 1, m_wall = 0, m_liver = 0;
};

}  // namespace

TEST(Spreading, X) {
  Work_ w("maryland");
  std::printf("first bond at %g %g %g apart %g %g %g\n", w.m_edge.x, w.m_edge.y, w.m_edge.z, w.m_apart.x, w.m_apart.y,
              w.m_apart.z);
  for (double deep : {0.0, 0.003, 0.006, 0.010}) {
    w.go(w.m_edge + deep * w.m_along - w.m_tip, 0.010);
    std::printf("deep %g share %g parted %d wall %g liver %g\n", deep, w.share(), w.parted(), w.m_wall, w.m_liver);
  }
  w.reset();
  w.spread(2.5);
  std::printf("spread: share %g parted %d wall %g liver %g handle %g\n", w.share(), w.parted(), w.m_wall, w.m_liver,
              w.m_handle);
}

TEST(Spreading, Y) {
  Work_ w("suction_irrigator");
  for (double deep : {0.0, 0.002, 0.004}) {
    w.go(w.m_edge + deep * w.m_along - w.m_tip, 0.010);
    std::printf("deep %g share %g parted %d wall %g liver %g\n", deep, w.share(), w.parted(), w.m_wall, w.m_liver);
  }
  const Vec3d across = cross(w.m_along, w.m_apart);
  for (int k = 0; k < 4; ++k) {
    w.reset();
    w.go((k % 2 ? -0.012 : 0.012) * across, 0.02);
    std::printf("wipe %d share %g parted %d wall %g liver %g\n", k, w.share(), w.parted(), w.m_wall, w.m_liver);
  }
}
