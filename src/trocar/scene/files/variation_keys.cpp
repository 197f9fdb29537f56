// Keys of what another seed makes of a scene.
#include <algorithm>

#include <trocar/core/text.hpp>
#include <trocar/scene/description/variant.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/reader_parts.hpp>
#include <trocar/scene/files/vessel_file.hpp>

namespace trocar::scene {
namespace {

using V = VariationSetting;

void check_region(const JsonObject& o, V::Region& r, Context&) {
  if (o.names("around") == o.names("centre_mm"))
    o.fault(o.at(), tr("expected either \"around\" or \"centre_mm\", got {}", o.names("around") ? "both" : "none"));
  if (r.begins >= r.whole)
    o.fault("whole_mm", tr("expected more than begins_mm = {}, got {}", 1000 * r.begins, 1000 * r.whole));
  if (r.near >= r.far) o.fault("far_mm", tr("expected more than near_mm = {}, got {}", 1000 * r.near, 1000 * r.far));
  if (o.has("axis") && !(length(r.axis) > 1e-6)) o.fault("axis", "expected a direction, got none");
  if (!(length(r.axis) > 1e-6)) r.axis = V::Region{}.axis;
}

const Table<V::Region>& region() {
  using R = Rows<V::Region>;
  using G = V::Region;
  static const Table<G> table{
      "region",
      "A smooth deformation of a part of space with all bodies in it: full around its middle, fading out further "
      "off. Figures are the largest random change in each direction.",
      {R::ref("around", Reference::To::solid_or_strand, &G::around,
              "its middle: where a strand begins, or the middle of a solid")
           .placed(&G::around_at),
       R::vec3("centre_mm", units::mm, &G::centre, -kFar, kFar, "or a place"),
       R::vec3("towards", units::one, &G::towards, -1, 1,
               "only on this side of the middle, any length, default: all around"),
       R::number("begins_mm", units::mm, &G::begins, -500, 500,
                 "distance in that direction at which it begins, default {}"),
       R::number("whole_mm", units::mm, &G::whole, -500, 500, "distance at which it is full, default {}"),
       R::number("near_mm", units::mm, &G::near, 0, 1000,
                 "distance from the middle up to which it is full, default {}"),
       R::number("far_mm", units::mm, &G::far, 1, 1000, "distance from which it is zero, default {}"),
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
      "Bodies that are thicker or thinner by a common factor.",
      {needed(R::refs("of", Reference::To::carrier, &V::Girth::of, "solids, strands, membranes and pouches")),
       needed(R::number("radius", units::one, &V::Girth::radius, 0, 0.5,
                        "of half axes, radii, a membrane's thickness; relative, at most"))}};
  return table;
}

const Table<V::Finding>& finding() {
  using R = Rows<V::Finding>;
  static const Table<V::Finding> table{
      "finding",
      "A finding of some patients: a mark and its related changes.",
      {needed(R::name("mark", &V::Finding::mark, "the mark, which is absent in the other patients")),
       R::texts("with", &V::Finding::with, "marks that are present together with it"),
       R::number("share", units::one, &V::Finding::share, 0, 1,
                 "share of patients with this finding, independent of others, always with seed 0; default {}: one of "
                 "`present`"),
       R::ref("solid", Reference::To::solid, &V::Finding::solid, "a lofted organ that is narrow there, default none"),
       R::number("narrower", units::one, &V::Finding::narrower, 0, 0.6, "its half axes, relative; default {}"),
       R::number("over_mm", units::mm, &V::Finding::over, 1, 200, "as far to either side, fading out; default {}")}};
  return table;
}

const Table<V::Variant::Hold>& variant_hold() {
  using H = V::Variant::Hold;
  using R = Rows<H>;
  static const Table<H> table{
      "variant hold",
      "An attachment of a pouch's wall to a body of the variant, for example to an artery's end.",
      {needed(R::ref("pouch", Reference::To::pouch, &H::pouch, "whose wall")),
       needed(R::ref("on", Reference::To::solid_or_strand, &H::on, "the body that carries it")),
       needed(R::vec3("centre_mm", units::mm, &H::centre, -kFar, kFar, "centre of the ball of attached nodes")),
       needed(R::number("radius_mm", units::mm, &H::radius, 0.1, 100, "its radius")),
       R::vec3("instead_mm", units::mm, &H::instead, -kFar, kFar,
               "the pouch's hold nearest to this point is removed; default: none")}};
  return table;
}

const Table<FatSetting::Fill>& more_fill() {
  using F = FatSetting::Fill;
  using R = Rows<F>;
  static const Table<F> table{
      "more fill",
      "A thick line.",
      {needed(R::points("line_mm", units::mm, &F::line, -kFar, kFar, 1, "its middle; one point: a ball")),
       needed(R::number("radius_mm", units::mm, &F::radius, 1, 100, "half its thickness"))}};
  return table;
}

const Table<V::Variant::MoreFat>& more_fat() {
  using F = V::Variant::MoreFat;
  using R = Rows<F>;
  static const Table<F> table{
      "more fat",
      "Additional volume of a fat of the scene; scenes without this fat ignore it.",
      {needed(R::name("of", &F::of, "the fat's name")),
       R::objects("fills", more_fill, &F::fills, 0, "additional positions"),
       R::refs("on", Reference::To::carrier, &F::on, "additional bodies that it is attached to")}};
  return table;
}

/// What a variant brings, as one list of a file.
template <class Write>
std::optional<JsonValue> brought(const V::Variant& v, bool any, Write&& write) {
  return v.brings && any ? std::optional<JsonValue>(write(*v.brings)) : std::nullopt;
}

std::vector<Row<V::Variant>> bringing_rows() {
  using T = V::Variant;
  using R = Rows<T>;
  return {R::own(
              keys::includes(
                  "organs", []() -> const Shape& { return organ_keys(); },
                  "bodies that it adds: files or objects; a body with a name of the scene replaces that one"),
              [](const JsonObject& o, T& v, Context& c) { c.reading->variant_bodies(o, c.folder, v); },
              [](const T& v, bool) {
                return brought(v, v.brings && !organ_keys().written(*v.brings).members.empty(),
                               [](const Description& d) { return json_array({organ_keys().written(d)}); });
              }),
          R::own(keys::includes("vessels", vessels_shape, "arteries and veins likewise, by the name of their file's"),
                 nullptr,
                 [](const T& v, bool) {
                   return brought(v, v.brings && !v.brings->vessels.empty(),
                                  [](const Description& d) { return listed(d.vessels, written_vessels); });
                 }),
          R::own(keys::objects(
                     "marks", []() -> const Shape& { return mark(); }, 0, "marks likewise"),
                 nullptr, [](const T& v, bool) {
                   return brought(v, v.brings && !v.brings->marks.empty(), [](const Description& d) {
                     return listed(d.marks, [](const MarkSetting& m) { return mark().written(m); });
                   });
                 })};
}

Row<V> variants_row() {
  return Rows<V>::own(
      keys::objects(
          "variants", []() -> const Shape& { return variant_keys(); }, 0,
          "variants of the anatomy: at most one for each patient"),
      [](const JsonObject& o, V& v, Context& c) {
        for (const JsonObject& one : o.objects("variants")) c.reading->variant(one, c.folder, v);
      },
      [](const V& v, bool) {
        return v.variants.empty() ? std::nullopt
                                  : std::optional<JsonValue>(listed(
                                        v.variants, [](const V::Variant& one) { return variant_keys().written(one); }));
      });
}

void check_variant_shares(const JsonObject& o, const V& v) {
  double sum = 0;
  for (std::size_t i = 0; i < v.variants.size(); ++i) {
    sum += v.variants[i].share;
    const auto same = [&](const V::Variant& other) { return other.name == v.variants[i].name; };
    const auto end = v.variants.begin() + std::ptrdiff_t(i);
    if (v.variants[i].name == kCommonAnatomy || std::any_of(v.variants.begin(), end, same))
      o.fault(v.variants[i].at, tr("expected a name of its own for every variant, and not \"{}\", got \"{}\"",
                                   kCommonAnatomy, v.variants[i].name));
  }
  if (sum > 1) o.fault("variants", tr("expected shares of at most 1 in all, got {:.3g}", sum));
}

void check_variation(const JsonObject& o, V& v, Context&) {
  check_variant_shares(o, v);
  const auto counted = std::count_if(v.findings.begin(), v.findings.end(), [](const auto& f) { return f.share <= 0; });
  if (v.present > int(counted))
    o.fault("present", tr("expected at most as many as there are findings, {}, got {}", counted, v.present));
}

}  // namespace

const Table<VariationSetting::Variant>& variant_keys() {
  using T = V::Variant;
  using R = Rows<T>;
  static const Table<T> table{
      "variant", "A variant of the anatomy in some patients.", [] {
        std::vector<Row<T>> rows{
            needed(R::name("name", &T::name, "its name in results")), needed(R::text("title", &T::title, "for people")),
            needed(R::number("share", units::one, &T::share, 0, 1, "share of patients with this variant")),
            needed(R::text("source", &T::source, "of the share: a publication, or \"our estimate\""))};
        for (Row<T>& row : bringing_rows()) rows.push_back(std::move(row));
        rows.push_back(R::objects("holds", variant_hold, &T::holds, 0, "attachments of pouches' walls to it"));
        rows.push_back(R::objects("fat", more_fat, &T::fat, 0, "additional volumes of fats of the scene"));
        return rows;
      }()};
  return table;
}

const Table<VariationSetting>& variation() {
  using R = Rows<V>;
  static const Table<V> table{
      "variation",
      "Differences that another seed makes, and their greatest size; without this key every seed is the standard "
      "patient.",
      {R::objects("regions", region, &V::regions, 0, "positions, sizes and rotations of bodies"),
       R::objects("girths", girth, &V::girths, 0, "thickness of bodies"),
       R::number("stiffness", units::one, &V::stiffness, 0, 0.9, "stiffness of every tissue, relative; default {}"),
       R::number("foundation", units::one, &V::foundation, 0, 0.9,
                 "stiffness of every strand's foundation, relative; default {}"),
       R::flag("bleeder", &V::bleeder, "true: the seed draws the bleeding hole; default {}: the first"),
       R::objects("findings", finding, &V::findings, 0, "findings of some patients"),
       R::integer("present", &V::present, 0, 64,
                  "number of findings that are present, drawn by the seed; with seed 0 the first; default {}"),
       variants_row()},
      check_variation};
  return table;
}

}  // namespace trocar::scene
