// Gmsh's .msh in its three generations: the sections. Text and binary share the code: only how a number is read
// differs.
//
//   1          $NOD, $ELM: one node, one element a line                          gmsh_plain.cpp
//   2.0-2.2    $Nodes, $Elements: the same with tags; binary elements in blocks  gmsh_plain.cpp
//   4.0, 4.1   blocks that belong to an entity (a volume)                        gmsh_blocks.cpp
//
// [Gmsh reference manual: MSH file format; legacy formats]
#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/gmsh_parts.hpp>

namespace trocar::geometry {
namespace {

class GmshReader {
 public:
  GmshReader(MeshSource& in, double scale) : m_in(in), m_parts{in, scale} {}

  TetFile read() {
    m_in.set_records_on_lines(true);
    for (m_in.skip_comments(); !m_in.only_padding_left(); m_in.skip_comments()) section();
    m_parts.resolve();
    m_in.finish();
    return {std::move(m_parts.mesh), format(), m_parts.left_out.notes(), PatientAxes::none};
  }

 private:
  MeshSource& m_in;
  GmshParts m_parts;

  std::string format() const {
    const int version = m_parts.version;
    const char* form = m_parts.form == MeshSource::Form::text     ? "text"
                       : m_parts.form == MeshSource::Form::binary ? "binary"
                                                                  : "binary, other byte order";
    if (version == 10) return "Gmsh 1, text";
    return fmt::format("Gmsh {}.{}, {}", version / 10, version % 10, form);
  }

  void section() {
    const std::size_t at = m_in.at();
    const std::string name(m_in.word());
    if (name[0] != '$') {
      m_in.fault(at, tr("expected a section such as $Nodes, got {}", in_quotes(name)));
      do m_in.skip_line();
      while (m_in.left() > 0 && m_in.peek_word().substr(0, 1) != "$");
      return;
    }
    m_in.skip_line();
    contents(name, at);
    m_in.set_form(MeshSource::Form::text);
    end_section(name);
  }

  static bool is_read(const std::string& name) {
    for (const char* known : {"$MeshFormat", "$NOD", "$ELM", "$Nodes", "$ParametricNodes", "$Elements", "$Entities"})
      if (name == known) return true;
    return false;
  }

  void contents(const std::string& name, std::size_t at) {
    if (name == "$MeshFormat") return header(at);
    if (!is_read(name)) return;
    const bool oldest = name == "$NOD" || name == "$ELM", parametric = name == "$ParametricNodes";
    need(at, name, oldest ? 10 : name == "$Entities" ? 40 : 20);
    const bool blocks = m_parts.version >= 40;
    if (name == "$Entities") return read_entities(m_parts);
    if (name == "$NOD" || name == "$Nodes" || parametric)
      return blocks ? read_node_blocks(m_parts) : read_plain_nodes(m_parts, parametric);
    blocks ? read_element_blocks(m_parts) : read_plain_elements(m_parts);
  }

  /// Sections of version 1 need no header; the others come after one of their version.
  void need(std::size_t at, const std::string& name, int version) {
    if (version == 10 && m_parts.version == 0) m_parts.version = 10;
    if (m_parts.version == 0) m_in.lose(at, tr("expected $MeshFormat in front of {}, got none", name));
    if ((version == 10) != (m_parts.version == 10) || m_parts.version < version)
      m_in.lose(at, tr("expected a section of format version {}, got {}", m_parts.version / 10, name));
  }

  void end_section(const std::string& name) {
    const std::string end = (m_parts.version == 10 ? "$END" : "$End") + name.substr(1);
    m_in.skip_space();
    const std::size_t at = m_in.at();
    if (is_read(name) && m_in.peek_word() != end)
      m_in.fault(at, tr("expected {}, got {}", in_quotes(end), m_in.shown(at)));
    const std::size_t found = m_in.all().find(end, at);
    if (found == std::string_view::npos)
      m_in.lose(m_in.all().size(), tr("expected {}, got the end of the file", in_quotes(end)));
    m_in.go_to(found + end.size());
  }

  void header(std::size_t section_at) {
    if (m_parts.version != 0) m_in.lose(section_at, "expected one $MeshFormat in front of all else, got another one");
    m_in.begin_record();
    std::size_t at = m_in.at();
    const std::string version(m_in.word());
    const double number = core::is_decimal(version) ? core::to_double(version) : 0.0;
    for (const int known : {20, 21, 22, 40, 41})
      if (10 * number > known - 0.5 && 10 * number < known + 0.5) m_parts.version = known;
    if (m_parts.version == 0) m_in.lose(at, tr("expected version 2.0 to 2.2, 4.0 or 4.1, got {}", in_quotes(version)));
    std::int64_t type = 0, size = 0;
    m_in.begin_value();
    at = m_in.at();
    if (!m_in.integer(type, 4, "the file type, 0 (text) or 1 (binary)")) m_in.finish();
    if (type != 0 && type != 1) m_in.lose(at, tr("expected file type 0 (text) or 1 (binary), got {}", type));
    m_in.begin_value();
    at = m_in.at();
    if (!m_in.integer(size, 4, "the size of a number, 8")) m_in.finish();
    if (size != 8) m_in.lose(at, tr("expected numbers of 8 bytes, got {}", size));
    m_in.skip_line();
    if (type == 1) byte_order();
  }

  /// Binary files show how they write the number one.
  void byte_order() {
    const std::size_t at = m_in.at();
    std::int64_t one = 0;
    m_in.set_form(MeshSource::Form::binary);
    m_in.integer(one, 4, "the number 1");
    if (one != 1 && one != 0x01000000) m_in.lose(at, tr("expected the number 1 as 4 bytes, got {}", one));
    m_parts.form = one == 1 ? MeshSource::Form::binary : MeshSource::Form::binary_swapped;
  }
};

}  // namespace

TetFile read_gmsh(MeshSource& in, double scale) { return GmshReader(in, scale).read(); }

}  // namespace trocar::geometry
