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
       R::flag("bleeder", &V::bleeder, "which of the bleeder's holes opens; default {}: the first")}};
  return table;
}

}  // namespace trocar::scene
