#pragma once
// Reading words and numbers out of text in memory.

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>

namespace tungsten {

/// Walks over text by words separated by blanks. Never reads past the end.
class TextCursor {
  public:
    explicit TextCursor(std::string_view text) : text_(text) {}

    [[nodiscard]] bool atEnd() const { return position_ >= text_.size(); }
    [[nodiscard]] size_t position() const { return position_; }

    /// The rest of this line without its end; moves to the next line.
    std::string_view nextLine() {
        const size_t end = std::min(text_.find('\n', position_), text_.size());
        std::string_view line = text_.substr(position_, end - position_);
        position_ = std::min(end + 1, text_.size());
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        return line;
    }
    /// The next word (line ends are blanks too); empty at the end.
    std::string_view nextWord() {
        while (!atEnd() && isBlank(text_[position_])) ++position_;
        const size_t start = position_;
        while (!atEnd() && !isBlank(text_[position_])) ++position_;
        return text_.substr(start, position_ - start);
    }

  private:
    static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0'; }

    std::string_view text_;
    size_t position_ = 0;
};

/// The whole word as a number, or none.
template <typename Number>
std::optional<Number> parseNumber(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

} // namespace tungsten
