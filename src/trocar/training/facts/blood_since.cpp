#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/blood.hpp>

namespace trocar::training {
namespace {

class Bleeding final : public Observer {
 public:
  Bleeding(const sim::Model&, const Arguments&) {}
  void sample(const Snapshot& snapshot, double) override {
    if (m_began < 0 && blood_lost(snapshot.model, snapshot.state) > 0) m_began = snapshot.now();
  }
  Value value(const Snapshot& snapshot) const override {
    return m_began < 0 ? kUnknown : Value(snapshot.now() - m_began);
  }

 private:
  double m_began = -1;
};

}  // namespace

const Fact kBloodSince{
    "blood.since_s",       {}, 0, 36000, "Time since the first blood left a vessel. Unknown before.", needs_fluids,
    &remembering<Bleeding>};

}  // namespace trocar::training
