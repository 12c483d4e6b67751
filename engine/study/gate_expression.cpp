#include "study/gate_expression.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

namespace steerstat {
namespace {

// ASCII alone, and whatever the locale.
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

template <std::size_t N>
std::optional<std::size_t> position_in(const std::array<std::string_view, N>& words, std::string_view word) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) return std::nullopt;
  return static_cast<std::size_t>(found - words.begin());
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  std::variant<GateExpression, GateSyntaxError> parse() {
    GateExpression expression;
    skip_space();
    const bool number_first = at_number();
    const bool done = number_first
                          ? take_number(expression) && take_comparison(expression) && take_quantity(expression)
                          : take_quantity(expression) && take_comparison(expression) && take_number(expression);
    if (!done) return error_;
    if (place_ != text_.size()) {
      refuse("the end of the expression");
      return error_;
    }
    if (number_first) expression.relation = mirrored(expression.relation);
    return expression;
  }

 private:
  static Relation mirrored(Relation relation) {
    switch (relation) {
      case Relation::less:
        return Relation::greater;
      case Relation::less_equal:
        return Relation::greater_equal;
      case Relation::greater:
        return Relation::less;
      default:
        return Relation::less_equal;
    }
  }

  [[nodiscard]] char peek(std::size_t ahead = 0) const {
    return place_ + ahead < text_.size() ? text_[place_ + ahead] : '\0';
  }

  void skip_space() {
    while (is_space(peek())) ++place_;
  }

  [[nodiscard]] bool at_number() const { return is_digit(peek()) || peek() == '-' || peek() == '.' || peek() == '+'; }

  /// The text from here to where a word, a number, a comparison or a single character ends.
  [[nodiscard]] std::string_view token() const {
    const auto run_of = [&](auto belongs) {
      std::size_t length = 0;
      while (place_ + length < text_.size() && belongs(peek(length))) ++length;
      return text_.substr(place_, length);
    };
    if (is_letter(peek())) return run_of([](char c) { return is_letter(c) || is_digit(c); });
    if (at_number()) {
      return run_of([](char c) { return is_letter(c) || is_digit(c) || c == '.' || c == '-' || c == '+'; });
    }
    const auto compares = [](char c) { return c == '<' || c == '>' || c == '=' || c == '!'; };
    if (compares(peek())) return run_of(compares);
    std::size_t length = place_ < text_.size() ? 1 : 0;
    while (place_ + length < text_.size() && continues_character(peek(length))) ++length;
    return text_.substr(place_, length);
  }

  bool refuse(std::string wanted) {
    std::size_t characters = 0;
    for (const char c : text_.substr(0, place_)) characters += continues_character(c) ? 0U : 1U;
    error_ = {characters + 1, std::string(token()), std::move(wanted)};
    return false;
  }

  bool take_quantity(GateExpression& expression) {
    const auto position = position_in(quantity_names, token());
    if (!position) return refuse("a quantity");
    expression.quantity = static_cast<Quantity>(*position);
    advance();
    return true;
  }

  bool take_comparison(GateExpression& expression) {
    const auto position = position_in(relation_names, token());
    if (!position) return refuse("<, <=, > or >=");
    expression.relation = static_cast<Relation>(*position);
    advance();
    return true;
  }

  bool take_number(GateExpression& expression) {
    const std::string_view digits = token();
    // from_chars also reads infinity, NaN, ".5" and "5."; a number is what JSON takes for one, but for leading noughts.
    const std::size_t first = digits.starts_with('-') ? 1 : 0;
    const std::size_t point = digits.find('.');
    const bool digit_missing =
        point != std::string_view::npos && (point + 1 == digits.size() || !is_digit(digits[point + 1]));
    if (digits.size() <= first || !is_digit(digits[first]) || digit_missing) return refuse("a number");
    double x = 0.0;
    const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (failure == std::errc::result_out_of_range) return refuse("a number that a double holds");
    if (failure != std::errc() || end != digits.data() + digits.size()) return refuse("a number");
    expression.bound = x + 0.0;  // -0 becomes 0, which is written and read alike
    advance();
    return true;
  }

  void advance() {
    place_ += token().size();
    skip_space();
  }

  std::string_view text_;
  std::size_t place_{0};
  GateSyntaxError error_;
};

}  // namespace

std::variant<GateExpression, GateSyntaxError> parse_gate_expression(std::string_view text) {
  return Parser(text).parse();
}

}  // namespace steerstat
