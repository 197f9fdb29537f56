#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/lumen_check.hpp>

namespace trocar::training {
namespace {

/// Clips, loops and cuts are all that changes a lumen, so it is looked at in ticks that report an event.
class Lumen : public Observer {
 public:
  Lumen(const sim::Model& model, const Arguments& a) : m_check(model, a[0].index, a[1].number()) {}
  void happened(const Snapshot& snapshot) override { m_check.update(snapshot.model, snapshot.state); }

 protected:
  LumenCheck m_check;
};

class Occluded final : public Lumen {
 public:
  using Lumen::Lumen;
  Value value(const Snapshot&) const override { return m_check.occluded(); }
};

class StumpsClosed final : public Lumen {
 public:
  using Lumen::Lumen;
  Value value(const Snapshot&) const override { return m_check.severed() ? Value(m_check.stumps_closed()) : kUnknown; }
};

class StumpsInView final : public Lumen {
 public:
  StumpsInView(const sim::Model& model, const Arguments& a)
      : Lumen(model, a), m_trace(model.target_index(model.strands[size_t(a[0].index)].name + ".trace")) {}
  Value value(const Snapshot& snapshot) const override {
    if (!m_check.severed()) return kUnknown;
    return stumps_in_view(snapshot.model, snapshot.state, m_trace, m_check.cut_element());
  }

 private:
  int m_trace;
};

std::vector<Parameter> stump_parameters() {
  return {{"of", ArgumentKind::strand, "which tube"},
          {"cover", ArgumentKind::number, "share of the cross-section from which a clip closes it", true, 0, 1}};
}

std::string no_trace(const sim::Model& model, const Arguments& a) {
  const sim::StrandAnatomy& strand = model.strands[size_t(a[0].index)];
  if (!strand.landmarks.empty()) return "";
  return "expected a strand with landmarks, which stumps need, got \"" + strand.name + "\", which has none";
}

}  // namespace

const Fact kStrandOccluded{
    "strand.occluded", stump_parameters(),     0,   1, "The lumen is blocked between the tube's start and its end.",
    anywhere,          &remembering<Occluded>, true};
const Fact kStrandStumpsClosed{"strand.stumps_closed",
                               stump_parameters(),
                               0,
                               1,
                               "A clip closes the strand on both sides of every cut. Unknown before a cut.",
                               anywhere,
                               &remembering<StumpsClosed>,
                               true};
const Fact kStrandStumpsInView{"strand.stumps_in_view",
                               stump_parameters(),
                               0,
                               1,
                               "Both stumps of the first cut are in view. Unknown before a cut.",
                               anywhere,
                               &remembering<StumpsInView>,
                               true,
                               no_trace};

}  // namespace trocar::training
