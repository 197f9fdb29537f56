// The tables of scene, organ, instrument and tissue files, a file a topic: organ_keys, fold_keys, instrument_keys,
// scene_keys, motion_keys, mark_keys, variation_keys. Ranges are what a person could mean, wide enough for any organ;
// they catch slips of units and of the decimal point. Private to the folder.
#pragma once

#include <array>
#include <cmath>
#include <initializer_list>

#include <trocar/core/text.hpp>
#include <trocar/scene/description/description.hpp>
#include <trocar/scene/files/rows.hpp>

namespace trocar::scene {

inline constexpr double kFar = 2000;              ///< [mm]: no place in a body is further from the umbilicus
inline constexpr double kMaxTriangles = 500'000;  ///< of a body's surface
inline constexpr double kMaxStrandNodes = 5'000;  ///< also columns of a membrane

const Table<Tissue>& tissue();
const Table<Solid>& solid();
const Table<Wall>& wall();
const Table<Strand>& strand();
const Table<Sheet>& sheet();
const Table<Membrane>& membrane();
const Table<Pouch>& pouch();
const Table<Instrument>& instrument();
const Table<WaveSetting>& wave();
const Table<BreathingSetting>& breathing();
const Table<DetailSetting>& detail();
const Table<VariationSetting>& variation();
const Table<VariationSetting::Variant>& variant_keys();
const Table<MarkSetting>& mark();
const Table<Anchor>& held_place();  ///< of a membrane
const Table<BondSetting>& bond_setting();

const Table<StiffnessRegion>& stiffness_region();  ///< of a solid, of a pouch
const Table<Section>& section();
/// One after the other they lie apart: the `each` of a body with sections.
template <class Body>
void check_last_section(const JsonObject& o, const Body& body) {
  const std::size_t n = body.sections.size();
  if (n > 1 && o.has("centre_mm") && !(length(body.sections[n - 1].centre - body.sections[n - 2].centre) >= 1e-5))
    o.fault("centre_mm", "expected a centre at least 0.01 mm from the section before, got the same place");
}

/// The rows of closed shapes that are no lofts (shape_keys.cpp): of a Solid, of a Pouch.
template <class Body>
std::vector<Row<Body>> shape_rows();
/// A fault where an object names none or more than one of them. @return how many
int check_one_shape(const JsonObject& o, std::initializer_list<const char*> shapes);

/// Rows of a net of control points, in millimetres.
JsonValue written_rows(const std::vector<Vec3d>& net, int columns);
/// Weights of control points, row by row, into T::weights; T has a number of columns.
template <class T>
Row<T> weights_row() {
  return {keys::table("weights", 1e-3, 1e3, 2, "of its control points, row by row; default: all 1"),
          [](const JsonObject& o, T& t, Context&) { t.weights = o.table("weights").values; },
          [](const T& t, bool) {
            std::vector<JsonValue> rows;
            for (std::size_t i = 0; t.columns > 0 && i + std::size_t(t.columns) <= t.weights.size();
                 i += std::size_t(t.columns))
              rows.push_back(listed(std::vector<double>(t.weights.begin() + std::ptrdiff_t(i),
                                                        t.weights.begin() + std::ptrdiff_t(i) + t.columns),
                                    json_number));
            return rows.empty() ? std::nullopt : std::optional<JsonValue>(json_array(std::move(rows)));
          }};
}
/// Two whole numbers, into T::degree.
template <class T>
Row<T> degree_row(const std::string& meaning) {
  Key key = keys::numbers("degree", 1, 7, 2, meaning);
  key.max_count = 2;
  return {std::move(key),
          [](const JsonObject& o, T& t, Context&) {
            const std::vector<double> two = o.numbers("degree");
            for (std::size_t k = 0; k < two.size(); ++k) {
              t.degree[k] = int(two[k]);
              if (two[k] != std::floor(two[k]))
                o.fault(o.at("degree", k), tr("expected a whole number for \"degree\", got {}", two[k]));
            }
          },
          [](const T& t, bool) {
            return t.degree == T{}.degree
                       ? std::nullopt
                       : std::optional<JsonValue>(listed(t.degree, [](int degree) { return json_number(degree); }));
          }};
}

const Table<Description>& organ_keys();       ///< an organ within another file
const Table<Description>& organ_file_keys();  ///< and as a file
const Table<Description>& scene_file_keys();
const Table<Instrument>& instrument_file_keys();
const Table<Description>& tissue_file_keys();

/// What its surface looks like; where nothing is said, as the look that is called as the body is.
template <class Body>
Row<Body> look_row() {
  return {keys::name("look", "its material, a file of looks/; default: the material with its name, else neutral"),
          [](const JsonObject& o, Body& body, Context& c) {
            body.look = o.text("look", body.name);
            if (o.has("look")) c.references.push_back({Reference::To::look, body.look, o.at("look")});
          },
          [](const Body& body, bool) {
            return body.look.empty() || body.look == body.name ? std::nullopt
                                                               : std::optional<JsonValue>(json_text(body.look));
          }};
}

/// Length of the Catmull-Rom curve through the points: within a few per cent of any smooth curve through them.
double curve_length(const std::vector<Vec3d>& points);
/// Is s beyond the strand's end? Smooth curves through the same points differ by a few per cent.
inline bool beyond(double s, double whole) { return whole > 0 && s > 1.05 * whole + 0.001; }
/// Each of these points lies apart from the one before. False where one does not.
bool check_apart(const JsonObject& o, const char* key, const std::vector<Vec3d>& points);

}  // namespace trocar::scene
