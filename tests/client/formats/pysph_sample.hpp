// PySPH's particles as Python pickles them, and numpy zips them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/containers/npz_writer.hpp"
#include "sample_files.hpp"

namespace meniscus::test {

inline std::string short_text(const std::string& text) {
    return std::string("X") + static_cast<char>(text.size()) + std::string(3, '\0') + text;
}
inline std::string small(int number) {
    return std::string("K") + static_cast<char>(number);
}

/// The pickle of numpy.array(numbers): a call, its arguments, and a state.
inline std::string numpy_array(const std::string& type, int count, const std::string& data) {
    const std::string call = std::string("cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n") + small(0) +
                             "\x85" + std::string("C\x01") + "b" + "\x87" + "R";
    const std::string dtype = std::string("cnumpy\ndtype\n") + short_text(type) + "\x89\x88\x87R(" + small(3) +
                              short_text("<") + "NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xff" + small(0) + "tb";
    return call + "(" + small(1) + small(count) + "\x85" + dtype + "\x89" + "C" + static_cast<char>(data.size()) +
           data + "tb";
}

template <class T>
std::string pickled_bytes(const std::vector<T>& values) {
    std::string out(values.size() * sizeof(T), '\0');
    std::memcpy(out.data(), values.data(), out.size());
    return out;
}

/// Two particles of one kind. object: in the array of one object as which numpy keeps a dictionary.
inline std::string sample_pickle(const std::string& kind = "fluid") {
    const std::string arrays = std::string("}(") + short_text("x") +
                               numpy_array("f8", 2, pickled_bytes<double>({1.0, 2.0})) + short_text("y") +
                               numpy_array("f8", 2, pickled_bytes<double>({3.0, 4.0})) + short_text("z") +
                               numpy_array("f8", 2, pickled_bytes<double>({5.0, 6.0})) + short_text("gid") +
                               numpy_array("u4", 2, pickled_bytes<std::uint32_t>({7, 9})) + short_text("dw") +
                               numpy_array("f4", 6, pickled_bytes<float>({1, 2, 3, 4, 5, 6})) + "u";
    const std::string kinds = "}" + short_text(kind) + "}" + short_text("arrays") + arrays + "ss";
    const std::string dtype =
        std::string("cnumpy\ndtype\n") + short_text("O8") + "\x89\x88\x87R(" + small(3) + short_text("|") + "tb";
    return std::string("\x80\x03") + "cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n" + small(0) + "\x85" +
           std::string("C\x01") + "b" + "\x87" + "R(" + small(1) + ")" + dtype + "\x89]" + kinds + "atb.";
}

/// The file that numpy.savez(FILE, version=2, particles=...) writes.
inline std::string sample_pysph_npz() {
    const TemporaryDirectory directory;
    formats::NpzWriter out(directory / "a.npz");
    out.add("version", "<i8", {}, pickled_bytes<std::int64_t>({2}));
    out.add("particles", "|O", {}, sample_pickle());
    out.commit();
    return formats::read_file(directory / "a.npz");
}

}  // namespace meniscus::test
