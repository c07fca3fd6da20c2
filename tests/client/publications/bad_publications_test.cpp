// Manifests and segments that are cut, changed, of a newer version, or of somebody hostile: one line, nothing else.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "meniscus/client/publication_writer.hpp"
#include "meniscus/sha256.hpp"
#include "publications/published_frames.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

using client::Publication;

Files two_frames() {
    const TemporaryDirectory folder;
    Row row;
    client::PublicationWriter writer(folder.path(), published_settings(), {});
    writer.add(row.frame(0), 0.04);
    writer.add(row.frame(1), 0.04);
    writer.finish();
    Files files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        files[entry.path().filename()] = formats::read_file(entry.path());
    return files;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), with);
}

/// With a manifest in which something is something else.
std::string refusal_of(const Files& files, const std::string& what, const std::string& with) {
    Files changed = files;
    changed["manifest.json"] = replaced(files.at("manifest.json"), what, with);
    return refusal([&] { publication_of(changed).frame(0); });
}

TEST(Manifest, OfALaterVersionIsRefusedAndUnknownFieldsAreNot) {
    const Files files = two_frames();
    EXPECT_EQ(refusal_of(files, "\"version\": 1", "\"version\": 2"),
              "p: a publication of format version 2; this program reads version 1: read it with the Meniscus that "
              "wrote it");
    EXPECT_EQ(refusal_of(files, "\"version\": 1", R"("version": 1, "later": {"a": [1, {}]})"), "");
    EXPECT_EQ(refusal_of(files, "\"sha256\"", R"("later": 3, "sha256")"), "");
    // Settings are for information.
    EXPECT_EQ(refusal_of(files, "FIELD_SMOOTH", "FIELD_OF_LATER"), "");
}

TEST(Manifest, ThatIsNoneIsRefusedInOneLine) {
    for (const std::string& text :
         std::vector<std::string>{"", "{", "[]", "{}", "null", "<html>not found</html>", "{\"format\": 3}", "\xff"}) {
        const std::string line = refusal([&] { publication_of({{"manifest.json", text}}); });
        EXPECT_EQ(line.find("p: "), 0U) << text;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
    const std::string deep(100000, '[');
    EXPECT_NE(refusal([&] { publication_of({{"manifest.json", "{\"later\": " + deep}}); }), "");
}

TEST(Manifest, ThatContradictsItselfOrNamesOtherFilesIsRefused) {
    const Files files = two_frames();
    const std::string sha256 = publication_of(files).info().segments[0].sha256;
    struct Case {
        std::string what, with, why;
    };
    const std::vector<Case> cases{
        {sha256, "../../../etc/passwd", "SHA-256"},
        {sha256, std::string(64, 'A'), "SHA-256"},
        {"\"seconds\": 0.08", "\"seconds\": -1", "shown for"},
        {"\"seconds\": 0.08", "\"seconds\": \"Infinity\"", "shown for"},
        {"\"frames\": 2,\n   \"seconds\"", "\"frames\": 0,\n   \"seconds\"", "frames"},
        {"\"frames\": 2,\n   \"seconds\"", "\"frames\": 4294967295,\n   \"seconds\"", "frames"},
        {"\"frames\": 2,\n   \"seconds\"", "\"frames\": 3,\n   \"seconds\"", "indices rise"},
        {"\"frames\": \"2\"", "\"frames\": \"18446744073709551615\"", "its segments have"},
        {"\"left_frames\": \"0\"", "\"left_frames\": \"18446744073709551615\"", "cannot be numbered"},
        {"\"last_frame\": \"1\"", "\"last_frame\": \"0\"", "indices rise"},
        {"\"components\": 1", "\"components\": 4000000000", "components"},
    };
    for (const Case& c : cases) EXPECT_NE(refusal_of(files, c.what, c.with).find(c.why), std::string::npos) << c.with;
}

TEST(Segment, ThatIsCutOrChangedAnywhereIsRefusedByItsName) {
    const Files files = two_frames();
    const std::string name = publication_of(files).info().segments[0].file();
    for (const std::size_t size : {std::size_t{0}, std::size_t{5}, files.at(name).size() - 1}) {
        Files cut = files;
        cut[name].resize(size);
        EXPECT_EQ(refusal([&] { publication_of(cut).frame(0); }),
                  "p: " + name + ": it has " + std::to_string(size) + " bytes; the manifest says " +
                      std::to_string(files.at(name).size()) + ": it was cut or changed");
    }
    for (std::size_t at = 0; at < files.at(name).size(); at += 97) {
        Files changed = files;
        changed[name][at] = static_cast<char>(changed[name][at] ^ 1);
        EXPECT_EQ(refusal([&] { publication_of(changed).frame(0); }),
                  "p: " + name + ": it does not have the SHA-256 of its name: it was changed");
    }
    Files gone = files;
    gone.erase(name);
    EXPECT_NE(refusal([&] { publication_of(gone).frame(0); }), "");
}

/// The publication's only segment with other bytes, of which the manifest knows.
Files with_segment(const Files& files, const std::string& bytes) {
    const auto segment = publication_of(files).info().segments[0];
    Files changed = files;
    changed.erase(segment.file());
    changed[sha256_of(bytes) + ".segment"] = bytes;
    std::string& manifest = changed["manifest.json"];
    manifest = replaced(manifest, segment.sha256, sha256_of(bytes));
    for (const char* const form : {"\"bytes\": \"", "\"bytes\": "})
        manifest = replaced(manifest, form + std::to_string(segment.bytes), form + std::to_string(bytes.size()));
    return changed;
}

TEST(Segment, OfALaterVersionOrWithAnotherIndexIsRefused) {
    const Files files = two_frames();
    const std::string bytes = files.at(publication_of(files).info().segments[0].file());
    const std::size_t version_at = bytes.find('\n') + 3;
    ASSERT_EQ(bytes[version_at], 1);
    std::string later = bytes;
    later[version_at] = 9;
    EXPECT_NE(refusal([&] { publication_of(with_segment(files, later)).frame(0); }).find("format version 9"),
              std::string::npos);
    for (const std::string& other :
         std::vector<std::string>{"Meniscus bricks\n" + bytes.substr(16), bytes + "x", bytes.substr(0, 40)})
        EXPECT_NE(refusal([&] { publication_of(with_segment(files, other)).frame(0); }), "");
    EXPECT_EQ(refusal([&] { publication_of(with_segment(files, bytes)).frame(1); }), "");
}

TEST(Publication, AFrameThatFailedIsNoMeshOfTheNextOne) {
    const Files files = two_frames();
    const std::string bytes = files.at(publication_of(files).info().segments[0].file());
    // The last bytes are the second frame's statistics, behind its bricks.
    const std::string broken = bytes.substr(0, bytes.size() - 100) + std::string(100, '\xff');
    Publication publication = publication_of(with_segment(files, broken));
    EXPECT_EQ(publication.frame(0).index, 0U);
    EXPECT_NE(refusal([&] { publication.frame(1); }), "");
    EXPECT_NE(refusal([&] { publication.frame(1); }), "");
    EXPECT_EQ(publication.frame(0).index, 0U);
}

}  // namespace
}  // namespace meniscus::test
