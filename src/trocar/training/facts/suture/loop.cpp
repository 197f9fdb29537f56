// Loops of slings on strands.
#include <algorithm>
#include <cmath>

#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/loops.hpp>

namespace trocar::training {
namespace {

std::optional<LoopSeen> on_strand(const Snapshot& m, const Arguments& a) {
  return loop_on(m.model, m.state, a[0].index, 0);
}
const sim::MarkModel& mark_of(const sim::Model& model, const Arguments& a) {
  return model.marks[size_t(model.targets[size_t(a[0].index)].index)];
}
Value closed(const Snapshot& m, const Arguments& a) {
  const auto loop = on_strand(m, a);
  return loop && loop->closes();
}
Value secured(const Snapshot& m, const Arguments& a) {
  const auto loop = on_strand(m, a);
  return loop && loop->closes() && loop->off;
}
Value at(const Snapshot& m, const Arguments& a) {
  const auto loop = on_strand(m, a);
  return loop ? Value(loop->closure.s) : kUnknown;
}
Value open_share(const Snapshot& m, const Arguments& a) {
  const auto loop = on_strand(m, a);
  return loop ? 1 - loop->closure.cover : 1.0;
}
Value stump(const Snapshot& m, const Arguments& a) {
  const auto loop = on_strand(m, a);
  return loop && loop->stump < 1e8 ? Value(loop->stump) : kUnknown;
}
Value pull(const Snapshot& m, const Arguments& a) {
  const auto loop = on_strand(m, a);
  return loop ? loop->pull : 0.0;
}
Value tension(const Snapshot& m, const Arguments& a) {
  const auto loop = on_strand(m, a);
  return loop ? loop->tension : 0.0;
}
Value count(const Snapshot& m, const Arguments& a) {
  const SecuredLoops loops = secured_loops(m.model, m.state, a[0].index);
  const auto end = loops.at.begin() + loops.count;
  return double(std::count_if(loops.at.begin(), end, [&](double s) { return !a[1].given || a[1].holds(s); }));
}
Value nth_at(const Snapshot& m, const Arguments& a) {
  const SecuredLoops loops = secured_loops(m.model, m.state, a[0].index);
  const int n = int(std::lround(a[1].number()));
  return n <= loops.count ? Value(loops.at[size_t(n) - 1]) : kUnknown;
}
Value to_mark(const Snapshot& m, const Arguments& a) {
  const sim::MarkModel& mark = mark_of(m.model, a);
  const auto loop = loop_on(m.model, m.state, mark.body(), mark.s);
  return loop ? Value(std::fabs(loop->closure.s - mark.s)) : kUnknown;
}

std::vector<Parameter> strand_parameter() { return {{"of", ArgumentKind::strand, "which tube"}}; }

std::string refuses_mark(const sim::Model& model, const Arguments& a) {
  const sim::VisibilityTarget& t = model.targets[size_t(a[0].index)];
  const bool stripe = t.kind == sim::VisibilityTarget::mark && model.marks[size_t(t.index)].is_stripe();
  return stripe ? "" : "expected a mark around a strand, got one that is elsewhere";
}

}  // namespace

const Fact kLoopClosed{"loop.closed", strand_parameter(), 0,   1, "A ligature loop around it closes its lumen.",
                       needs_sling,   &stateless<closed>, true};
const Fact kLoopSecured{"loop.secured",
                        strand_parameter(),
                        0,
                        1,
                        "A ligature loop around it closes its lumen, and the loop's tail has been cut.",
                        needs_sling,
                        &stateless<secured>,
                        true};
const Fact kLoopAt{
    "loop.at_mm", strand_parameter(), 0, 1000, "Position of a loop around it, from its start. Unknown without a loop.",
    needs_sling,  &stateless<at>};
const Fact kLoopToMark{"loop.to_mark_mm",
                       {{"of", ArgumentKind::mark, "a mark around a strand"}},
                       0,
                       1000,
                       "Distance along the strand from the mark's centre to the nearest loop. Unknown without a loop.",
                       needs_sling,
                       &stateless<to_mark>,
                       false,
                       &refuses_mark};
const Fact kLoopOpenShare{
    "loop.open_share", strand_parameter(),    0, 1, "Share of the lumen's width that a loop leaves open.",
    needs_sling,       &stateless<open_share>};
const Fact kLoopStump{"loop.stump_mm",
                      strand_parameter(),
                      0,
                      1000,
                      "Distance from a loop around it to the nearest end. Unknown without a loop.",
                      needs_sling,
                      &stateless<stump>};
const Fact kLoopPull{
    "loop.pull_N", strand_parameter(), 0, 1000, "Pull of a loop on the strand, towards the tube of the instrument.",
    needs_sling,   &stateless<pull>};
const Fact kLoopTension{"loop.tension_N", strand_parameter(), 0, 1000, "Tension of a loop around it.",
                        needs_sling,      &stateless<tension>};
const Fact kLoopsCount{
    "loops.count",
    {{"of", ArgumentKind::strand, "which tube"},
     {"within_mm", ArgumentKind::range, "a part of it; without it: the whole strand", false, 0, 1000}},
    0,
    sim::kMostLoops,
    "Number of loops around it that close its lumen and have a cut tail.",
    needs_sling,
    &stateless<count>};
const Fact kLoopsAt{"loops.at_mm",
                    {{"of", ArgumentKind::strand, "which tube"},
                     {"nth", ArgumentKind::number, "number of the loop; 1 is the first from the strand's start", true,
                      1, sim::kMostLoops}},
                    0,
                    1000,
                    "Position of that loop from the strand's start. Unknown while there are fewer loops.",
                    needs_sling,
                    &stateless<nth_at>};

}  // namespace trocar::training
