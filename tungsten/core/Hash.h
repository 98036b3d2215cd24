#pragma once
// Fingerprints of bytes.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace tungsten {

/// FNV-1a, 64 bits. Each step is a bijection: two inputs that differ in one byte never agree.
class Hash {
  public:
    void addBytes(const char* bytes, size_t count) {
        for (size_t i = 0; i < count; ++i) value_ = (value_ ^ static_cast<unsigned char>(bytes[i])) * Prime;
    }
    /// Of many bytes: eight at a time, some times as soon, and another value. Of these steps each is a bijection, too.
    void addMany(const char* bytes, size_t count) {
        uint64_t word = 0;
        for (; count >= sizeof word; bytes += sizeof word, count -= sizeof word) {
            std::memcpy(&word, bytes, sizeof word);
            value_ = (value_ ^ word) * Prime;
            value_ ^= value_ >> 32; // a product's high bits reach no lower ones
        }
        addBytes(bytes, count);
    }
    /// Text and its end: "ab", "c" differ from "a", "bc".
    void add(const std::string& text) {
        addBytes(text.data(), text.size());
        value_ *= Prime;
    }
    [[nodiscard]] uint64_t value() const { return value_; }

  private:
    static constexpr uint64_t Prime = 0x100000001B3ull;
    uint64_t value_ = 0xCBF29CE484222325ull;
};

} // namespace tungsten
