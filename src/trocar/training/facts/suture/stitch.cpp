// How needle and thread lie in tissue.
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/stitches.hpp>

namespace trocar::training {
namespace {

Value to_mark(const Snapshot& snapshot, const Arguments& a, bool entry) {
  const double off = bite_to_mark(snapshot.model, snapshot.state, a[0].index, entry);
  return off >= 0 ? Value(off) : kUnknown;
}
Value entry_to_mark(const Snapshot& snapshot, const Arguments& a) { return to_mark(snapshot, a, true); }
Value exit_to_mark(const Snapshot& snapshot, const Arguments& a) { return to_mark(snapshot, a, false); }
Value passages(const Snapshot& snapshot, const Arguments& a) {
  return double(passages_through(snapshot.state, a[0].body()));
}
Value peak(const Snapshot& snapshot, const Arguments&) { return suture_of(snapshot.state).peak; }
Value strain(const Snapshot& snapshot, const Arguments&) { return suture_of(snapshot.state).strain; }
Value torn(const Snapshot& snapshot, const Arguments&) { return double(suture_of(snapshot.state).torn); }
Value clips(const Snapshot& snapshot, const Arguments&) { return double(suture_of(snapshot.state).thread.clip_count); }
/// Of the thread, from the clip that is nearest to tissue to where it goes in.
Value clip_to_tissue(const Snapshot& snapshot, const Arguments&) {
  const double off = clip_to_hole(suture_of(snapshot.state));
  return off >= 0 ? Value(off) : kUnknown;
}
Value broken(const Snapshot& snapshot, const Arguments&) { return suture_of(snapshot.state).broken != 0; }
Value harmed(const Snapshot& snapshot, const Arguments&) {
  const interactions::SutureState& s = suture_of(snapshot.state);
  for (int i = 0; i < s.bite_count; ++i)
    if (s.bites[size_t(i)].harmed) return true;
  return false;
}
Value holds_needle(const Snapshot& snapshot, const Arguments& a) {
  return held_of_suture(snapshot.model, snapshot.state, size_t(a[0].index)) == 1;
}
Value holds_thread(const Snapshot& snapshot, const Arguments& a) {
  return held_of_suture(snapshot.model, snapshot.state, size_t(a[0].index)) == 2;
}
Value needle_in_view(const Snapshot& snapshot, const Arguments&) {
  return needle_in_picture(snapshot.model, snapshot.state);
}
/// Of the thread that is through tissue, from the swage to the nearest hole.
Value drawn_through(const Snapshot& snapshot, const Arguments&) {
  const interactions::SutureState& s = suture_of(snapshot.state);
  double least = -1;
  for (int i = 0; i < s.hole_count; ++i) {
    const interactions::SutureHole& hole = s.holes[size_t(i)];
    if (hole.slot >= 0 && (least < 0 || double(hole.arc) < least)) least = double(hole.arc);
  }
  return least >= 0 ? Value(least) : Value(0.0);
}

}  // namespace

const Fact kSutureEntry{
    "suture.entry_to_mark_mm",
    {{"of", ArgumentKind::mark, "a mark on an organ or a fold"}},
    0,
    1000,
    "Distance from the needle's entry into that body to the mark, on the undeformed body; of several bites "
    "the nearest. Unknown before the first bite.",
    needs_needle,
    &stateless<entry_to_mark>};
const Fact kSutureExit{"suture.exit_to_mark_mm",
                       {{"of", ArgumentKind::mark, "a mark on an organ or a fold"}},
                       0,
                       1000,
                       "Distance from the needle's exit to the mark, likewise.",
                       needs_needle,
                       &stateless<exit_to_mark>};
const Fact kSuturePassages{"suture.passages",
                           {{"through", ArgumentKind::body, "which body"}},
                           0,
                           32,
                           "Number of complete passages of needle or thread through it, from entry to exit.",
                           needs_suture,
                           &stateless<passages>};
const Fact kSutureDrawn{"suture.drawn_through_mm",
                        {},
                        0,
                        1000,
                        "Length of thread from the needle to the nearest stitched tissue; 0 where the thread goes "
                        "through none.",
                        needs_thread,
                        &stateless<drawn_through>};
const Fact kSuturePeak{
    "suture.peak_N", {}, 0, 1000, "Largest load of needle and thread on tissue at one point so far.", needs_suture,
    &stateless<peak>};
const Fact kSutureTension{"suture.tension_N", {}, 0, 1000, "Present largest tension of the thread.", needs_thread,
                          &stateless<strain>};
const Fact kSutureTorn{"suture.torn_out", {}, 0, 32, "Number of stitches torn out of tissue so far.", needs_suture,
                       &stateless<torn>};
const Fact kSutureBroken{
    "suture.broken",    {},  0, 1, "The thread was broken by a pull, or crushed between instruments.", needs_thread,
    &stateless<broken>, true};
const Fact kSutureClips{
    "suture.clips", {}, 0, suture::kMostThreadClips, "Number of clips on the thread.", needs_thread, &stateless<clips>};
const Fact kSutureClipToTissue{"suture.clip_to_tissue_mm",
                               {},
                               0,
                               1000,
                               "Length of thread from a clip on it to the nearest place where it goes into tissue or "
                               "comes out; of several clips the nearest. Unknown without a clip, or a stitch.",
                               needs_thread,
                               &stateless<clip_to_tissue>};
const Fact kSutureHarmed{"suture.harmed",
                         {},
                         0,
                         1,
                         "A stitch was pulled harder than its tissue withstands without damage.",
                         needs_suture,
                         &stateless<harmed>,
                         true};
const Fact kSutureNeedleHeld{"suture.needle_held",
                             {{"hand", ArgumentKind::hand, "whose jaws"}},
                             0,
                             1,
                             "The jaws hold the needle.",
                             needs_needle,
                             &stateless<holds_needle>,
                             true};
const Fact kSutureThreadHeld{"suture.thread_held",
                             {{"hand", ArgumentKind::hand, "whose jaws"}},
                             0,
                             1,
                             "The jaws hold the thread.",
                             needs_thread,
                             &stateless<holds_thread>,
                             true};
const Fact kSutureNeedleInView{
    "suture.needle_in_picture", {},  0, 1, "The needle's tip or its middle is in the endoscope's view.", needs_needle,
    &stateless<needle_in_view>, true};

}  // namespace trocar::training
