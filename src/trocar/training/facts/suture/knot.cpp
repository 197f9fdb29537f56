// What the thread is tied in. Reading a knot costs some milliseconds, so that it is read anew twice a second.
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/stitches.hpp>

namespace trocar::training {
namespace {

class Knotted : public Observer {
 public:
  Knotted(const sim::Model&, const Arguments&) {}
  void sample(const Moment& moment, double dt) override {
    m_since += dt;
    if (m_since < kEvery) return;
    m_since = 0;
    m_known.update(knot_of(moment.model, moment.state));
    m_above = knot().count > 0 ? knot_above_tissue(moment.model, moment.state, knot()) : 0;
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
  Value value(const Moment&) const override { return double(knot().count); }
};
class Turns final : public Knotted {
 public:
  Turns(const sim::Model& model, const Arguments& a) : Knotted(model, a), m_which(int(a[0].number())) {}
  Value value(const Moment&) const override {
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
  Value value(const Moment&) const override { return knot().kind == kind; }
};
class Above final : public Knotted {
 public:
  using Knotted::Knotted;
  Value value(const Moment&) const override { return knot().count > 0 ? Value(m_above) : kUnknown; }
};
class Tail final : public Knotted {
 public:
  using Knotted::Knotted;
  Value value(const Moment&) const override {
    return knot().count > 0 ? Value(std::min(knot().tail, knot().standing)) : kUnknown;
  }
};

Value wrapped(const Moment& moment, const Arguments& a) {
  return wraps_around(moment.model, moment.state, size_t(a[0].index));
}

}  // namespace

const Fact kKnotThrows{"knot.throws",
                       {},
                       0,
                       8,
                       "How many throws the thread is tied in, above tissue that it goes through.",
                       needs_thread,
                       &remembering<Throws>};
const Fact kKnotTurns{"knot.turns",
                      {{"throw", ArgumentKind::number, "which, 1: the one next to the tissue", true, 1, 8}},
                      -8,
                      8,
                      "How often both sides turn round each other in that throw; below 0: left-handed. Unknown where "
                      "there is none.",
                      needs_thread,
                      &remembering<Turns>};
const Fact kKnotSquare{"knot.square",
                       {},
                       0,
                       1,
                       "Each throw is the opposite of the one before it.",
                       needs_thread,
                       &remembering<Is<suture::KnotKind::square>>,
                       true};
const Fact kKnotGranny{
    "knot.granny", {}, 0, 1, "Two throws in a row are alike.", needs_thread, &remembering<Is<suture::KnotKind::granny>>,
    true};
const Fact kKnotSlip{"knot.slip",
                     {},
                     0,
                     1,
                     "One side is straight and the other one goes round it.",
                     needs_thread,
                     &remembering<Is<suture::KnotKind::slip>>,
                     true};
const Fact kKnotAbove{"knot.above_tissue_mm",
                      {},
                      0,
                      1000,
                      "From the first throw to the tissue that the thread goes through. Unknown without a throw.",
                      needs_thread,
                      &remembering<Above>};
const Fact kKnotTail{"knot.tail_mm",
                     {},
                     0,
                     1000,
                     "The shorter side's length beyond the last throw. Unknown without a throw.",
                     needs_thread,
                     &remembering<Tail>};
const Fact kThreadWraps{
    "thread.wraps",
    {{"hand", ArgumentKind::hand, "whose instrument"}},
    -20,
    20,
    "How often the thread winds round the last 3 cm of its shaft and its jaws; below 0: left-handed "
    "about the way that it points.",
    needs_thread,
    &stateless<wrapped>};

}  // namespace trocar::training
