// The bytes of a mesh file, word by word or value by value, and what is wrong with them. Mesh formats mix both: lines
// of text announce values, and these follow as text or as the machine's own numbers.
//
//   MeshSource in(bytes, "liver.msh");
//   in.word();                                   // "$NOD"
//   const std::size_t n = in.count("nodes", 8);  // never more than the bytes that are left can hold
//   in.begin_record();
//   if (in.real(x, 8, "an x coordinate")) ...    // false: told already
//   in.finish();                                 // throws core::BadInput with all faults
//
// Text is read as people's programs write it, in whatever format: with a byte order mark or without, lines that end in
// LF, CR LF or CR, '#' and what follows it among numbers as a comment.
//
// Faults are kept by byte position; lines and columns are counted once, when they are reported. Among the machine's own
// numbers lines end where a byte happens to be a line feed, so that the byte is reported beside them. What is wrong
// with the file as a whole is reported at its beginning. Used by the readers only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>

namespace trocar::geometry {

inline constexpr std::size_t kMaxMeshBytes = 256u << 20;
inline constexpr std::size_t kMaxMeshFaults = 50;  ///< told of one file; then reading stops

class MeshSource {
 public:
  /// Begins behind a byte order mark.
  MeshSource(std::string_view bytes, std::string file);
  /// @throws core::BadInput for text in UTF-16 or UTF-32, which every tool can save as UTF-8
  void refuse_wide_text() const;

  /// How numbers stand from here on.
  enum class Form : unsigned char { text, binary, binary_swapped };
  void set_form(Form form) { m_form = form; }
  bool binary() const { return m_form != Form::text; }
  /// Text only: must a record's numbers stand on one line? (Then a short line costs no more than itself.)
  void set_records_on_lines(bool yes) { m_by_line = yes; }

  std::size_t at() const { return m_at; }
  void go_to(std::size_t at) { m_at = at; }
  std::size_t left() const { return m_bytes.size() - m_at; }
  std::string_view all() const { return m_bytes; }
  const std::string& file() const { return m_file; }  ///< as faults show it

  std::string_view line();       ///< what is left of this line, without its end; goes to the next one
  void skip_space();             ///< and line ends
  std::string_view word();       ///< the next one on any line; empty at the end of the file
  std::string_view peek_word();  ///< the same, and stays in front of it
  bool word_on_line();           ///< is there another one on this line, in front of a comment?
  void skip_comments();          ///< and space and line ends: to the next word that is none
  bool only_padding_left();      ///< nothing but space, zeros and the sign for the end of a text (0x1a)?

  void begin_value();    ///< text: to the next word, on this line where records stand on lines
  bool value_follows();  ///< text: is there another one where begin_value() looks?
  void begin_record();   ///< text: to the next word, on whatever line
  void end_record();     ///< text: to the next line; what is left on this one is a fault
  void skip_line();      ///< text: to the next line, whatever stands here

  /// The next number, `width` bytes where it is binary (integers 1, 2, 4, 8, signed; reals 4, 8). False: a fault, told
  /// as "expected WHAT, got ...". Binary ones beyond the end of the file are thrown.
  bool integer(std::int64_t& value, int width, const char* what);
  bool real(double& value, int width, const char* what);
  /// A number of things of at least `least` bytes each.
  std::size_t count(const char* things, std::size_t least, int width = 8);
  void skip_bytes(std::uint64_t bytes, const char* what);

  void fault(std::size_t at, std::string message);              ///< continues
  [[noreturn]] void lose(std::size_t at, std::string message);  ///< the structure is lost: throws all
  void finish() const;                                          ///< throws if there was any
  std::size_t faults() const { return m_faults.size(); }

  /// How a fault names the word at `at`: 'abc', the end of the line, the end of the file.
  std::string shown(std::size_t at) const;

 private:
  struct Fault {
    std::size_t at;
    bool binary;
    std::string message;
  };
  const unsigned char* take(int width, const char* what);
  bool number_word(std::string_view& text, std::size_t& at, const char* what);
  [[noreturn]] void tell_all() const;

  std::string_view m_bytes;
  std::string m_file;
  std::size_t m_at = 0;
  Form m_form = Form::text;
  bool m_by_line = false;
  bool m_ends_in_cr;  ///< lines do, in the file's text: a line feed behind such an end is data
  std::vector<Fault> m_faults;
};

/// Text from a file as a fault shows it: short, and nothing that a terminal would obey.
std::string in_quotes(std::string_view text);

}  // namespace trocar::geometry
