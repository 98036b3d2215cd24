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

    /// The rest of this line without its end (LF, CR LF, or CR); moves to the next line.
    std::string_view nextLine() {
        size_t end = endsInCr_ ? text_.find_first_of("\r\n", position_) : text_.find('\n', position_);
        end = std::min(end, text_.size());
        std::string_view line = text_.substr(position_, end - position_);
        if (const size_t cr = line.find('\r'); cr != std::string_view::npos) {
            if (cr + 1 < line.size() || end == text_.size()) {
                endsInCr_ = true;
                end = position_ + cr;
            }
            line = line.substr(0, cr);
        }
        position_ = std::min(end + 1, text_.size());
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
    bool endsInCr_ = false; ///< some line does: an LF after one is not its, and may be the first byte of numbers
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
