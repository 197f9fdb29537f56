// Steps as no person would write them: every operation with values of every kind, in range and out of it. They are
// refused with a reason or done; the texts stay JSON, and undoing gives every byte back.
#include <random>

#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/document/outline.hpp>
#include <trocar/modeller/operations/values.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

class Nonsense {
 public:
  explicit Nonsense(unsigned seed) : m_random(seed) {}

  int below(int n) { return int(m_random() % unsigned(n)); }

  double any_number() {
    const double edges[] = {0, 1, -1, 1e-300, 1e300, -1e9, 0.5, 3, 17, 1e6};
    return below(3) == 0 ? edges[below(10)] : 0.1 * (below(4001) - 2000);
  }
  std::string any_name() {
    const char* names[] = {"ball", "bag",     "cord", "trunk", "veil",       "ties",
                           "",     "no such", "a/b",  "~0",    "solid:ball", "\"\\"};
    return names[below(12)];
  }
  scene::JsonValue point_or_not() {
    if (below(8) == 0) return scene::json_array({number(any_number()), number(any_number())});
    return point({any_number(), any_number(), any_number()});
  }
  scene::JsonValue of_type(const scene::Key& key) {
    using Type = scene::Key::Type;
    if (below(12) == 0) return anything(2);
    switch (key.type) {
      case Type::flag:
        return scene::json_flag(below(2) == 0);
      case Type::vec3:
        return point_or_not();
      case Type::points: {
        std::vector<scene::JsonValue> items;
        for (int i = below(6); i > 0; --i) items.push_back(point_or_not());
        return scene::json_array(std::move(items));
      }
      case Type::texts:
        return scene::json_array({scene::json_text(any_name()), scene::json_text(any_name())});
      case Type::text:
      case Type::name:
        if (!key.choices.empty()) return scene::json_text(key.choices[std::size_t(below(int(key.choices.size())))]);
        return scene::json_text(any_name());
      default:
        break;
    }
    if (!key.choices.empty()) return scene::json_text(key.choices[std::size_t(below(int(key.choices.size())))]);
    return below(4) == 0 ? anything(3) : scene::json_number(any_number());
  }
  scene::JsonValue anything(int depth) {
    switch (below(depth > 0 ? 6 : 4)) {
      case 0:
        return scene::json_number(any_number());
      case 1:
        return scene::json_text(any_name());
      case 2:
        return scene::json_flag(true);
      case 3:
        return {};
      case 4:
        return scene::json_array({anything(depth - 1), anything(depth - 1)});
      default: {
        scene::JsonValue object = scene::json_object();
        scene::put(object, "name", anything(depth - 1));
        scene::put(object, "centre_mm", anything(depth - 1));
        return object;
      }
    }
  }
  scene::JsonValue step(const Operation& operation) {
    scene::JsonValue parameters = scene::json_object();
    for (const scene::Key& key : operation.parameters.keys)
      if (key.required ? below(15) > 0 : below(2) == 0) scene::put(parameters, key.name, of_type(key));
    return parameters;
  }

 private:
  std::mt19937 m_random;
};

Document with_one_of_each(const Workplace& place) {
  Document document = begun(place / "scene.json", false, "mine");
  apply(document, "ellipsoid",
        R"({"name": "ball", "tissue": "uterus", "centre_mm": [10, -150, -110], "half_mm": [15, 25, 12]})");
  apply(document, "ellipsoid",
        R"({"name": "bag", "tissue": "uterus", "centre_mm": [10, -150, -92], "half_mm": [9, 15, 6], "pouch": true})");
  apply(document, "bond_facing", R"({"of": "bag", "on": "ball", "name": "ties", "within_mm": 6})");
  apply(
      document, "cord",
      R"({"name": "cord", "tissue": "round_ligament", "line_mm": [[0, -100, -90], [30, -100, -90]], "radius_mm": 2})");
  return document;
}

void expect_json(const Document& document) {
  for (const fs::path& file : document.files()) {
    std::vector<core::Fault> faults;
    scene::parse_json(document.text(file), file.generic_string(), faults);
    EXPECT_TRUE(faults.empty()) << core::to_string(faults.front());
  }
}

TEST(HostileSteps, AreDoneOrRefusedWithAReasonAndUndoneToTheByte) {
  constexpr int kSteps = 3000;
  const Workplace place;
  Document document = with_one_of_each(place);
  const std::size_t begun_with = document.done();
  const std::string before = document.text(document.root());
  Nonsense nonsense(5);
  int done = 0, refused = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Operation& operation = operations()[std::size_t(nonsense.below(int(operations().size())))];
    if (operation.parameters.name == "fit_spline" || operation.parameters.name == "from_file") continue;  // read files
    const scene::JsonValue step = nonsense.step(operation);
    SCOPED_TRACE(operation.parameters.name + " " + scene::to_text(step));
    try {
      modeller::apply(operation, step, "step", document);
      ++done;
      expect_json(document);
    } catch (const core::BadInput& bad) {
      ++refused;
      ASSERT_FALSE(bad.faults().empty());
      for (const core::Fault& f : bad.faults()) EXPECT_FALSE(f.message.empty());
    }
    if (testing::Test::HasFailure()) return;
    while (document.done() > begun_with + 6) document.undo();  // small again
  }
  EXPECT_GT(done, kSteps / 50);
  EXPECT_GT(refused, kSteps / 10);
  while (document.done() > begun_with) document.undo();
  EXPECT_EQ(document.text(document.root()), before);
}

}  // namespace
}  // namespace trocar::modeller
