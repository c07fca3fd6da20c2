// What is said to people on standard error, names of files among it, as it may stand on a terminal.
#pragma once

#include <streambuf>

namespace meniscus::cli {

/// In front of std::cerr's buffer for as long as it lives: what is written goes through visible().
class VisibleErrors : public std::streambuf {
public:
    VisibleErrors();
    ~VisibleErrors() override;
    VisibleErrors(const VisibleErrors&) = delete;
    VisibleErrors& operator=(const VisibleErrors&) = delete;

protected:
    int_type overflow(int_type c) override;
    std::streamsize xsputn(const char* text, std::streamsize size) override;
    int sync() override;

private:
    std::streambuf* terminal_;
};

}  // namespace meniscus::cli
