#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/operations/first_organ.hpp>
#include <trocar/modeller/operations/operation.hpp>
#include <trocar/modeller/operations/values.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

constexpr Vec3d kMiddle{0, -150, -110}, kHalf{18, 25, 18};  // [mm]
constexpr double kBehind = 14, kHoldRadius = 11;            // [mm] of its attachment, at the back

void do_step(Document& document, const char* operation, const std::vector<std::pair<const char*, JsonValue>>& values) {
  JsonValue parameters = scene::json_object();
  for (const auto& [key, value] : values) scene::put(parameters, key, value);
  apply(*find_operation(operation), parameters, "new organ", document);
}

}  // namespace

Document first_organ(const fs::path& file, const std::string& title) {
  Document document = begun(file, false, title);
  do_step(document, "ellipsoid",
          {{"name", scene::json_text("organ")},
           {"tissue", scene::json_text("uterus")},
           {"centre_mm", point(kMiddle)},
           {"half_mm", point(kHalf)}});
  do_step(document, "hold",
          {{"of", scene::json_text("solid:organ")},
           {"centre_mm", point(kMiddle - Vec3d{0, 0, kBehind})},
           {"radius_mm", number(kHoldRadius)}});
  return Document::fresh(file, document.text(document.root()));
}

}  // namespace trocar::modeller
