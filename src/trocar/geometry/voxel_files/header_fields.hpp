// Headers of text, as NRRD and MetaImage have them: a field a line, and faults at their places. Used by the readers
// only.
//
//   HeaderFields header = read_fields(bytes, file, "=", "ElementDataFile");
//   const HeaderField* sizes = header.find("DimSize");
//   const std::vector<double> n = header.numbers(*sizes, 3, 3);
//   header.finish();                                  // throws all faults
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>

namespace trocar::geometry {

struct HeaderField {
  std::string name;        ///< in lower case
  std::string_view value;  ///< without blanks around it
  int line = 0, column = 0;
};

class HeaderFields {
 public:
  explicit HeaderFields(std::string file) : m_file(std::move(file)) {}

  std::vector<HeaderField> fields;
  std::size_t end = 0;  ///< bytes of the header: where data would follow
  int last_line = 0;

  const HeaderField* find(std::string_view lower_name) const;  ///< the first of this name, or null
  const HeaderField* need(std::string_view lower_name);        ///< the same, a fault where there is none

  /// Between `least` and `most` of them, each within +-1e9, apart by blanks, commas or brackets; else a fault, and
  /// zeros.
  std::vector<double> numbers(const HeaderField& field, std::size_t least, std::size_t most);
  std::vector<std::int64_t> integers(const HeaderField& field, std::size_t least, std::size_t most);

  void fault(const HeaderField& field, std::string message);
  void fault(int line, int column, std::string message);
  [[noreturn]] void lose(int line, int column, std::string message);
  void finish() const;

 private:
  std::string m_file;
  std::vector<core::Fault> m_faults;
};

/// Reads fields "name SEPARATOR value" up to an empty line (where `last` is empty) or through the field called `last`
/// (lower case). Lines that begin with # are passed over. NRRD's "key:=value" become fields "key:=" with that value.
HeaderFields read_fields(std::string_view bytes, const std::string& file, char separator, std::string_view last);

/// Throws core::BadInput for a file as a whole: `file:0:0: message`.
[[noreturn]] void refuse(const std::string& file, std::string message);

/// Text from a file as a message shows it: short, and nothing that a terminal would obey.
std::string shown(std::string_view text);

}  // namespace trocar::geometry
