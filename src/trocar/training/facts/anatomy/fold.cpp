// Folds that carry a strand, and what has been divided of them.
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/folds.hpp>

namespace trocar::training {
namespace {

/// Looked at ten times a second.
class FoldWhole final : public Observer {
 public:
  FoldWhole(const sim::Model& model, const Arguments& a)
      : m_columns(model, int(a[0].body().index())), m_from(a[1].low), m_to(a[1].high) {}
  void sample(const Snapshot& snapshot, double) override {
    constexpr int kFoldTurns = 5;
    if (m_turn++ % kFoldTurns == 0) m_value = m_columns.whole_between(snapshot.model, snapshot.state, m_from, m_to);
  }
  Value value(const Snapshot&) const override { return m_turn > 0 ? Value(m_value) : kUnknown; }

 private:
  FoldColumns m_columns;
  double m_from, m_to, m_value = 0;
  int m_turn = 0;
};

std::string no_fold(const sim::Model& model, const Arguments& a) {
  return FoldColumns::there(model, a[0].body()) ? "" : "expected a fold that hangs on a strand, got another body";
}

}  // namespace

const Fact kFoldWhole{
    "fold.whole_mm",
    {{"of", ArgumentKind::body, "a fold that hangs on a strand"},
     {"between_mm", ArgumentKind::range, "stretch of that strand, from its beginning", true, 0, 1000}},
    0,
    1000,
    "Length of that stretch along which the fold still ties the strand to its root, uncut from border to "
    "border.",
    anywhere,
    &remembering<FoldWhole>,
    false,
    &no_fold};

}  // namespace trocar::training
