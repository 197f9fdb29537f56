// A key is one row: reading, writing, the schema and what people read about it follow.
#include <gtest/gtest.h>

#include <trocar/scene/files/rows.hpp>
#include <trocar/scene/json/schema.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

struct Ring {
  enum class Colour { red, blue } colour = Colour::blue;
  double diameter = 0.012;  // [m]
  int holes = 1;
  std::string name;
  std::vector<Vec3d> path;
};

const Table<Ring>& ring() {
  using R = Rows<Ring>;
  static const Table<Ring> table{
      "ring",
      "A ring.",
      {needed(R::name("name", &Ring::name, "what it is called")),
       R::number("diameter_mm", units::mm, &Ring::diameter, 1, 50, "outer, default {}"),
       R::integer("holes", &Ring::holes, 0, 9, "default {}"),
       R::choice("colour", Choices<Ring::Colour>{{"red", Ring::Colour::red}, {"blue", Ring::Colour::blue}},
                 &Ring::colour, "default {}"),
       R::points("path_mm", units::mm, &Ring::path, -100, 100, 0, "where it goes, default: nowhere")}};
  return table;
}

struct Read {
  std::vector<core::Fault> faults;
  std::vector<Reference> references;
  Ring value;
  explicit Read(const std::string& text) {
    const JsonDocument document = parse_json(text, "ring.json", faults);
    Context context{{}, nullptr, references};
    value = ring().made(JsonObject(document.root, ring(), document.file, faults), context);
  }
};

TEST(Rows, WhatAFileSaysArrivesInItsMemberAndTheRestKeepsItsDefault) {
  const Read r(R"({"name": "peg", "diameter_mm": 14.3, "colour": "red", "path_mm": [[1, 2, 3]]})");
  EXPECT_EQ(told(r.faults), std::vector<std::string>{});
  EXPECT_EQ(r.value.diameter, 0.0143);
  EXPECT_EQ(r.value.colour, Ring::Colour::red);
  EXPECT_EQ(r.value.holes, 1);
  EXPECT_EQ(r.value.path, (std::vector<Vec3d>{{0.001, 0.002, 0.003}}));
}

TEST(Rows, AValueThatIsWrongIsToldAndTheDefaultStands) {
  const Read r(R"({"name": "peg", "diameter_mm": 51, "colour": "bleu"})");
  EXPECT_EQ(told(r.faults),
            (std::vector<std::string>{
                "1:32 expected a number in [1, 50] for \"diameter_mm\", got 51",
                "1:46 expected one of red, blue for \"colour\", got \"bleu\" (did you mean \"blue\"?)"}));
  EXPECT_EQ(r.value.diameter, Ring{}.diameter);
  EXPECT_EQ(r.value.colour, Ring{}.colour);
}

TEST(Rows, WhatIsWrittenReadsBackToTheBitAndLeavesDefaultsOut) {
  Ring ring_now;
  ring_now.name = "peg";
  EXPECT_EQ(to_text(ring().written(ring_now)), "{\"name\": \"peg\"}\n");
  ring_now.diameter = 0.0123456789012345;
  ring_now.colour = Ring::Colour::red;
  ring_now.path = {{0.001, -0.0307, 0}};
  const Read again(to_text(ring().written(ring_now)));
  EXPECT_EQ(again.value.diameter, ring_now.diameter);
  EXPECT_EQ(again.value.colour, ring_now.colour);
  EXPECT_EQ(again.value.path, ring_now.path);
}

TEST(Rows, ThePublishedTextShowsTheMembersDefaultInTheFilesUnit) {
  EXPECT_EQ(ring().find("diameter_mm")->meaning, "outer, default 12");
  EXPECT_EQ(ring().find("colour")->meaning, "default blue");
  const std::string schema = json_schema(ring());
  EXPECT_NE(schema.find("\"description\": \"outer, default 12\""), std::string::npos) << schema;
  EXPECT_NE(schema.find("\"maximum\": 50"), std::string::npos);
  EXPECT_NE(schema.find("\"required\": [\"name\"]"), std::string::npos);
}

}  // namespace
}  // namespace trocar::scene
