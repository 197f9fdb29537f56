#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/liquid.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

/// What stands under the pool cannot be controlled yet: that time does not count.
class Uncovered final : public Observer {
 public:
  Uncovered(const sim::Model& model, const Arguments&) : m_mark(model.target_index("bleeder")) {}
  void sample(const Snapshot& snapshot, double passed) override {
    if (snapshot.state.tick < snapshot.model.vessels.bleeder.tick) return;
    if (!drowned(snapshot.model, snapshot.state, place_of_mark(snapshot.model, snapshot.state, m_mark)))
      m_free += passed;
  }
  Value value(const Snapshot&) const override { return m_free; }

 private:
  int m_mark;
  double m_free = 0;  ///< [s]
};

std::string_view needs_bleeder_in_pool(const sim::Model& model) {
  if (!needs_bleeder(model).empty()) return needs_bleeder(model);
  if (model.target_index("bleeder") < 0) return "a bleeder on a body";  // nothing carries it
  return model.wet.there ? "" : "fluids";
}

}  // namespace

const Fact kBleederUncovered{"bleeder.uncovered_s",
                             {},
                             0,
                             36000,
                             "Total time that the bleeding point has been open without pooled blood "
                             "covering it.",
                             needs_bleeder_in_pool,
                             &remembering<Uncovered>};

}  // namespace trocar::training
