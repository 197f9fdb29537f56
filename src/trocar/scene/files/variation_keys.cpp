// Keys of what another seed makes of a scene.
#include <trocar/scene/files/keys.hpp>

namespace trocar::scene {
namespace {

using V = VariationSetting;

void check_region(const JsonObject& o, V::Region& r, Context&) {
  if (o.names("around") == o.names("centre_mm"))
    o.fault(o.at(),
            fmt::format("expected either \"around\" or \"centre_mm\", got {}", o.names("around") ? "both" : "none"));
  if (r.begins >= r.whole)
    o.fault("whole_mm", fmt::format("expected more than begins_mm = {}, got {}", 1000 * r.begins, 1000 * r.whole));
  if (r.near >= r.far)
    o.fault("far_mm", fmt::format("expected more than near_mm = {}, got {}", 1000 * r.near, 1000 * r.far));
  if (o.has("axis") && !(length(r.axis) > 1e-6)) o.fault("axis", "expected a direction, got none");
  if (!(length(r.axis) > 1e-6)) r.axis = V::Region{}.axis;
}

const Table<V::Region>& region() {
  using R = Rows<V::Region>;
  using G = V::Region;
  static const Table<G> table{
      "region",
      "A part of space that is bent, smoothly, with all that lies there: whole about its middle, fading out further "
      "off. Figures are the most that a seed takes, to either side.",
      {R::ref("around", Reference::To::solid_or_strand, &G::around,
              "its middle: where a strand begins, or the middle of a solid")
           .placed(&G::around_at),
       R::vec3("centre_mm", units::mm, &G::centre, -kFar, kFar, "or a place"),
       R::vec3("towards", units::one, &G::towards, -1, 1,
               "only on this side of the middle, any length, default: all around"),
       R::number("begins_mm", units::mm, &G::begins, -500, 500, "way in that direction at which it begins, default {}"),
       R::number("whole_mm", units::mm, &G::whole, -500, 500, "and at which it is whole, default {}"),
       R::number("near_mm", units::mm, &G::near, 0, 1000, "distance from the middle to which it is whole, default {}"),
       R::number("far_mm", units::mm, &G::far, 1, 1000, "from which on there is nothing of it, default {}"),
       R::number("scale", units::one, &G::scale, 0, 0.5, "of lengths, relative; default {}"),
       R::number("length", units::one, &G::length, 0, 0.5, "of lengths along the axis, relative; default {}"),
       R::number("shift_mm", units::mm, &G::shift, 0, 50, "along x, y and z, default {}"),
       R::number("turn_deg", units::deg, &G::turn, 0, 45, "about the axis, default {}"),
       R::vec3("axis", units::one, &G::axis, -1, 1, "any length, default {}")},
      check_region};
  return table;
}

const Table<V::Girth>& girth() {
  using R = Rows<V::Girth>;
  static const Table<V::Girth> table{
      "girth",
      "Bodies that are thicker or thinner, all by one share.",
      {needed(R::refs("of", Reference::To::carrier, &V::Girth::of, "solids, strands, membranes and pouches")),
       needed(R::number("radius", units::one, &V::Girth::radius, 0, 0.5,
                        "of half axes, radii, a membrane's thickness; relative, at most"))}};
  return table;
}

const Table<V::Finding>& finding() {
  using R = Rows<V::Finding>;
  static const Table<V::Finding> table{
      "finding",
      "Something that is found in some patients and not in others: a mark, and what goes with it.",
      {needed(R::name("mark", &V::Finding::mark, "the mark, which is left out where it is not found")),
       R::ref("solid", Reference::To::solid, &V::Finding::solid, "a lofted organ that is narrow there, default none"),
       R::number("narrower", units::one, &V::Finding::narrower, 0, 0.6, "its half axes, relative; default {}"),
       R::number("over_mm", units::mm, &V::Finding::over, 1, 200, "as far to either side, fading out; default {}")}};
  return table;
}

void check_variation(const JsonObject& o, V& v, Context&) {
  if (v.present > int(v.findings.size()))
    o.fault("present",
            fmt::format("expected at most as many as there are findings, {}, got {}", v.findings.size(), v.present));
}

}  // namespace

const Table<VariationSetting>& variation() {
  using R = Rows<V>;
  static const Table<V> table{
      "variation",
      "What another seed makes different, and by how much at most; without this key every seed is as drawn.",
      {R::objects("regions", region, &V::regions, 0, "where bodies lie, how large they are and how they are turned"),
       R::objects("girths", girth, &V::girths, 0, "how thick they are"),
       R::number("stiffness", units::one, &V::stiffness, 0, 0.9, "of every tissue, relative; default {}"),
       R::number("foundation", units::one, &V::foundation, 0, 0.9, "of every strand's hold, relative; default {}"),
       R::flag("bleeder", &V::bleeder, "which of the bleeder's holes opens; default {}: the first"),
       R::objects("findings", finding, &V::findings, 0, "what is found in some patients"),
       R::integer("present", &V::present, 0, 64,
                  "so many of the findings are there, drawn by the seed; with seed 0 the first; default {}")},
      check_variation};
  return table;
}

}  // namespace trocar::scene
