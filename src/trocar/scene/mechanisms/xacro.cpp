#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/json.hpp>
#include <trocar/scene/mechanisms/xacro.hpp>

namespace trocar::scene {
namespace {

constexpr std::size_t kToldPlaces = 8;  // of what is left over
constexpr std::size_t kLongestShown = 60;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The command that expands the file.
std::string remedy(const std::string& file) {
  const std::string stem = file.substr(0, file.size() - (ends_with(file, ".xacro")  ? 6
                                                         : ends_with(file, ".urdf") ? 5
                                                                                    : 0));
  const std::string out =
      ends_with(stem, ".urdf") ? stem : stem + (ends_with(file, ".xacro") ? ".urdf" : "_expanded.urdf");
  return fmt::format("xacro {} -o {}", core::printable(file), core::printable(out));
}

class XacroSearch {
 public:
  XacroSearch(const std::string& file, std::vector<core::Fault>& faults) : m_file(file), m_faults(faults) {}

  bool find(const XmlElement& root) {
    if (ends_with(m_file, ".xacro")) {
      left({m_file, root.line, root.column}, tr("a .xacro file"));
    } else {
      look(root);
      for (const XmlElement& e : root.children)  // as files before its namespace have it
        if (std::any_of(kOld.begin(), kOld.end(), [&e](const char* name) { return e.name == name; }))
          left({m_file, e.line, e.column}, fmt::format("<{}>", e.name));
    }
    if (m_count > kToldPlaces)
      tell(m_faults, {{m_file, 0, 0},
                      tr("expected no xacro, got {} more of its elements and expressions", m_count - kToldPlaces)});
    return m_count > 0;
  }

 private:
  static constexpr std::array<const char*, 4> kOld = {"macro", "property", "include", "insert_block"};

  void left(core::Location at, const std::string& what) {
    if (++m_count <= kToldPlaces)
      tell(m_faults, {std::move(at), tr("expected a robot that xacro has expanded, got {}, so that parts of it are "
                                        "missing. Expand it: {}",
                                        what, remedy(m_file))});
  }

  /// A prefix counts as xacro's by its usual name, or by what it is declared as.
  bool is_xacro(const std::string& name) const {
    const std::size_t colon = name.find(':');
    return colon != name.npos && m_prefixes.count(name.substr(0, colon)) > 0;
  }

  void look(const XmlElement& e) {
    for (const XmlAttribute& a : e.attributes)
      if (a.name.compare(0, 6, "xmlns:") == 0 && a.value.find("xacro") != a.value.npos)
        m_prefixes.insert(a.name.substr(6));
    if (is_xacro(e.name)) return left({m_file, e.line, e.column}, fmt::format("<{}>", core::printable(e.name)));
    for (const XmlAttribute& a : e.attributes) {
      const bool expression = a.value.find("${") != a.value.npos;
      const bool argument = a.name != "filename" && a.value.find("$(") != a.value.npos;  // files are not read
      if (expression || argument)
        left({m_file, a.line, a.column}, fmt::format("\"{}\"", core::printable(a.value.substr(0, kLongestShown))));
    }
    for (const XmlElement& child : e.children) look(child);
  }

  const std::string& m_file;
  std::vector<core::Fault>& m_faults;
  std::set<std::string> m_prefixes = {"xacro"};
  std::size_t m_count = 0;
};

}  // namespace

bool tell_of_xacro(const XmlElement& root, const std::string& file, std::vector<core::Fault>& faults) {
  return XacroSearch(file, faults).find(root);
}

}  // namespace trocar::scene
