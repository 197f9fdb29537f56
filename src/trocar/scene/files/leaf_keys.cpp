#include <trocar/scene/files/keys.hpp>

namespace trocar::scene {
namespace {

const Table<LeafSetting>& leaf() {
  using R = Rows<LeafSetting>;
  static const Table<LeafSetting> table{
      "leaf",
      "A thin sheet that lies on other bodies, tied to them by loose tissue, or that is held at places: a leaf of "
      "peritoneum, a piece of gauze.",
      {needed(R::name("name", &LeafSetting::name, "its name in scenes and exercises")),
       needed(R::ref("tissue", Reference::To::tissue, &LeafSetting::tissue, "its material")), look_row<LeafSetting>(),
       needed(R::lines("lines_mm", units::mm, &LeafSetting::lines, -kFar, kFar, 2,
                       "lines of points that it is spanned over, from one border to the other")),
       needed(R::number("thickness_mm", units::mm, &LeafSetting::thickness, 0.05, 20, "of the sheet")),
       R::number("spacing_mm", units::mm, &LeafSetting::spacing, 0.3, 50, "distance of its nodes, default {}"),
       R::objects("held", held_place, &LeafSetting::held, 0, "places where it is held, default none"),
       R::refs("held_on", Reference::To::solid_or_strand, &LeafSetting::held_on,
               "solids and strands that hold it where they are near; elsewhere it stays in place"),
       R::number("held_reach_mm", units::mm, &LeafSetting::held_reach, 0.1, 100,
                 "how near that is, from a strand's surface or a skin, default {}"),
       R::objects("bonds", bond_setting, &LeafSetting::bonds, 0, "bonds between it and other bodies, default none"),
       R::flag("cuttable", &LeafSetting::cuttable, "default {}")}};
  return table;
}

}  // namespace

Key LeafScene::row() {
  Key row = keys::objects(
      kKey, []() -> const Shape& { return leaf(); }, 0, "thin sheets that lie on other bodies, default none");
  row.max_count = 16;
  return row;
}

LeafSetting LeafScene::read(const JsonObject& o, Context& c) {
  LeafSetting s = leaf().made(o, c);
  s.text = o.value();
  return s;
}

}  // namespace trocar::scene
