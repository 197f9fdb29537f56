// What the thread is tied in. Reading a knot costs some milliseconds, so that it is read again twice a second.
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/stitches.hpp>

namespace trocar::training {
namespace {

class Knotted : public Observer {
 public:
  Knotted(const sim::Model&, const Arguments&) {}
  void sample(const Snapshot& snapshot, double dt) override {
    m_since += dt;
    if (m_since < kEvery) return;
    m_since = 0;
    m_known.update(knot_of(snapshot.model, snapshot.state));
    m_above = knot().count > 0 ? knot_above_tissue(snapshot.model, snapshot.state, knot()) : 0;
  }

 protected:
  static constexpr double kEvery = 0.5;  // [s]
  const suture::KnotReading& knot() const { return m_known.knot(); }
  suture::KnownKnot m_known;
  double m_above = 0, m_since = 0;
};

class Throws final : public Knotted {
 public:
  using Knotted::Knotted;
  Value value(const Snapshot&) const override { return double(knot().count); }
};
class Turns final : public Knotted {
 public:
  Turns(const sim::Model& model, const Arguments& a) : Knotted(model, a), m_which(int(a[0].number())) {}
  Value value(const Snapshot&) const override {
    if (m_which < 1 || m_which > knot().count) return kUnknown;
    const suture::KnotThrow& t = knot().throws[size_t(m_which - 1)];
    return double(t.turns * t.sign);
  }

 private:
  int m_which;
};
template <suture::KnotKind kind>
class Is final : public Knotted {
 public:
  using Knotted::Knotted;
  Value value(const Snapshot&) const override { return knot().kind == kind; }
};
class Above final : public Knotted {
 public:
  using Knotted::Knotted;
  Value value(const Snapshot&) const override { return knot().count > 0 ? Value(m_above) : kUnknown; }
};
class Tail final : public Knotted {
 public:
  using Knotted::Knotted;
  Value value(const Snapshot&) const override {
    return knot().count > 0 ? Value(std::min(knot().tail, knot().standing)) : kUnknown;
  }
};

Value wrapped(const Snapshot& snapshot, const Arguments& a) {
  return wraps_around(snapshot.model, snapshot.state, size_t(a[0].index));
}

}  // namespace

const Fact kKnotThrows{
    "knot.throws",       {}, 0, 8, "Number of throws of the knot over the stitched tissue.", needs_thread,
    &remembering<Throws>};
const Fact kKnotTurns{
    "knot.turns",
    {{"throw", ArgumentKind::number, "number of the throw; 1 is next to the tissue", true, 1, 8}},
    -8,
    8,
    "Number of turns of both sides around each other in that throw; negative: left-handed. Unknown where "
    "there is none.",
    needs_thread,
    &remembering<Turns>};
const Fact kKnotSquare{"knot.square",
                       {},
                       0,
                       1,
                       "Each throw has the opposite handedness of the one before it.",
                       needs_thread,
                       &remembering<Is<suture::KnotKind::square>>,
                       true};
const Fact kKnotGranny{"knot.granny",
                       {},
                       0,
                       1,
                       "Two successive throws have the same handedness.",
                       needs_thread,
                       &remembering<Is<suture::KnotKind::granny>>,
                       true};
const Fact kKnotSlip{"knot.slip",
                     {},
                     0,
                     1,
                     "One side is straight and the other one winds around it.",
                     needs_thread,
                     &remembering<Is<suture::KnotKind::slip>>,
                     true};
const Fact kKnotAbove{"knot.above_tissue_mm",
                      {},
                      0,
                      1000,
                      "Distance from the first throw to the stitched tissue. Unknown without a throw.",
                      needs_thread,
                      &remembering<Above>};
const Fact kKnotTail{"knot.tail_mm",
                     {},
                     0,
                     1000,
                     "Length of the shorter end beyond the last throw. Unknown without a throw.",
                     needs_thread,
                     &remembering<Tail>};
const Fact kThreadWraps{
    "thread.wraps",
    {{"hand", ArgumentKind::hand, "whose instrument"}},
    -20,
    20,
    "Number of turns of the thread around the last 3 cm of the shaft and the jaws; negative: left-handed "
    "about the pointing direction.",
    needs_thread,
    &stateless<wrapped>};

}  // namespace trocar::training
