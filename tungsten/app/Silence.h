#pragma once
// Ranks that do not speak.

#include <iostream>
#include <streambuf>

namespace tungsten {

/// While it lives nothing reaches standard output by std::cout, which takes it for written.
class Silence {
  public:
    Silence() : loud_(std::cout.rdbuf(&nothing_)) {}
    ~Silence() { std::cout.rdbuf(loud_); }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

  private:
    class Nothing : public std::streambuf {
        int_type overflow(int_type character) override { return traits_type::not_eof(character); }
        std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
    };
    Nothing nothing_;
    std::streambuf* loud_;
};

} // namespace tungsten
