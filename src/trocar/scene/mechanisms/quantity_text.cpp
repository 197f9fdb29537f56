#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/scene/mechanisms/quantity_text.hpp>

namespace trocar::scene {

using kinematics::Measure;
using kinematics::Parameter;
using kinematics::Quantity;

namespace {

constexpr std::size_t kLongestText = 200, kMostTerms = 16;

bool is_word_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
}
bool is_digit_of_text(char c) { return c >= '0' && c <= '9'; }

const char* word_for(Measure measure) {
  return measure == Measure::length ? "a length" : measure == Measure::angle ? "an angle" : "a ratio";
}

/// sum := [sign] product { sign product }; product := number | number * name | name * number | name
class QuantityText {
 public:
  QuantityText(std::string_view text, const std::vector<Parameter>& parameters, Measure measure, double unit)
      : m_text(text), m_parameters(parameters), m_measure(measure), m_unit(unit) {}

  QuantityReading read() {
    if (m_text.size() > kLongestText) {
      fail(tr("at most {} characters, got {}", kLongestText, m_text.size()));
      return std::move(m_out);
    }
    skip();
    double sign = 1;
    if (peek() == '-' || peek() == '+') sign = take() == '-' ? -1 : 1;
    product(sign);
    while (good() && m_at < m_text.size()) {
      const char c = take();
      if (c != '+' && c != '-') {
        fail(tr("'+' or '-' between terms, got '{}'", c));
        break;
      }
      product(c == '-' ? -1 : 1);
    }
    if (good() && m_out.quantity.terms.size() > kMostTerms)
      fail(tr("at most {} terms, got {}", kMostTerms, m_out.quantity.terms.size()));
    return std::move(m_out);
  }

 private:
  bool good() const { return m_out.fault.empty(); }
  void fail(const std::string& what) { m_out.fault = "expected " + what; }
  char peek() const { return m_at < m_text.size() ? m_text[m_at] : '\0'; }
  void skip() {
    while (peek() == ' ') ++m_at;
  }
  char take() {
    const char c = m_text[m_at++];
    skip();
    return c;
  }

  void product(double factor) {
    int parameter = -1;
    for (bool more = true; more && good();) {
      one(factor, parameter);
      more = good() && peek() == '*';
      if (more) take();
    }
    if (!good()) return;
    if (parameter < 0)
      m_out.quantity.constant += factor * m_unit;
    else
      m_out.quantity.terms.push_back({parameter, m_measure == Measure::ratio ? factor * m_unit : factor});
  }

  void one(double& factor, int& parameter) {
    std::string word;
    while (is_word_letter(peek()) || (!word.empty() && is_digit_of_text(word[0]) &&
                                      (word.back() == 'e' || word.back() == 'E') && (peek() == '-' || peek() == '+')))
      word += m_text[m_at++];
    skip();
    if (word.empty())
      return fail(m_at < m_text.size() ? tr("a number or a parameter, got '{}'", peek())
                                       : std::string("a number or a parameter, got the end of the text"));
    if (is_digit_of_text(word[0]) || word[0] == '.') {
      if (!core::is_decimal(word)) return fail(tr("a number, got \"{}\"", word));
      factor *= core::to_double(word);
      return;
    }
    if (parameter >= 0) return fail(tr("one parameter in a product, got \"{}\" as well", word));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < m_parameters.size(); ++i) {
      names.push_back(m_parameters[i].name);
      if (m_parameters[i].name == word) parameter = int(i);
    }
    if (parameter < 0) {
      m_out.fault = unknown_name("parameter", word, names);
    } else if (m_parameters[std::size_t(parameter)].measure != m_measure) {
      fail(tr("{}, got \"{}\", which is {}", word_for(m_measure), word,
              word_for(m_parameters[std::size_t(parameter)].measure)));
    }
  }

  std::string_view m_text;
  const std::vector<Parameter>& m_parameters;
  Measure m_measure;
  double m_unit;
  std::size_t m_at = 0;
  QuantityReading m_out;
};

}  // namespace

QuantityReading read_quantity(std::string_view text, const std::vector<Parameter>& parameters, Measure measure,
                              double unit) {
  return QuantityText(text, parameters, measure, unit).read();
}

double value_of(const Quantity& quantity, const std::vector<Parameter>& parameters) {
  double sum = quantity.constant;
  for (const Quantity::Term& t : quantity.terms) sum += t.factor * parameters[std::size_t(t.parameter)].value;
  return sum;
}

}  // namespace trocar::scene
