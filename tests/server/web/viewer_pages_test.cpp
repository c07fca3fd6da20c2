// The viewer's files, as browsers ask for them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "meniscus/error.hpp"
#include "observation/http_client.hpp"
#include "viewer_files.hpp"
#include "web/accepts_gzip.hpp"
#include "web/frame_ancestors.hpp"
#include "web/http_server.hpp"
#include "web/viewer_pages.hpp"

namespace meniscus::server::test {
namespace {

Router router(const FrameAncestors& ancestors = {}) {
    Router router;
    add_viewer_pages(router, ancestors);
    return router;
}

class ViewerPages : public testing::Test {
protected:
    HttpAnswer ask(const std::string& target, const std::string& fields = "", const std::string& method = "GET") {
        client.send(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n");
        return client.receive(method == "HEAD");
    }
    static std::string field(const HttpAnswer& answer, const std::string& name) {
        const std::size_t at = answer.header.find("\r\n" + name + ": ");
        if (at == std::string::npos) return {};
        const std::size_t first = at + name.size() + 4;
        return answer.header.substr(first, answer.header.find("\r\n", first) - first);
    }

    const HttpServer server{"127.0.0.1:0", router()};
    HttpClient client{server.address()};
};

TEST_F(ViewerPages, ThePageAllowsNothingButItsOwnFiles) {
    const HttpAnswer page = ask("/");
    EXPECT_EQ(page.status, 200);
    EXPECT_NE(page.body.find("<title>Meniscus</title>"), std::string::npos);
    EXPECT_TRUE(field(page, "Content-Security-Policy").starts_with("default-src 'none'; script-src 'self'"));
    EXPECT_EQ(field(page, "X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(field(page, "Referrer-Policy"), "no-referrer");
    EXPECT_EQ(field(page, "Cross-Origin-Opener-Policy"), "same-origin");
    // Nothing is written into the page that the policy would forbid.
    EXPECT_EQ(page.body.find(" style="), std::string::npos);
    EXPECT_EQ(page.body.find("<style"), std::string::npos);
    EXPECT_EQ(page.body.find("<script>"), std::string::npos);
}

TEST_F(ViewerPages, MayBeFramedByPagesThatAreListedAndByNoOthers) {
    const std::string alone = field(ask("/"), "Content-Security-Policy");
    EXPECT_TRUE(alone.ends_with("; frame-ancestors 'none'")) << alone;
    const HttpServer listed("127.0.0.1:0", router(FrameAncestors({"https://a.example", "http://b.example:8443"})));
    HttpClient other(listed.address());
    for (const viewer::File& file : viewer::files()) {
        other.send(fmt::format("GET {} HTTP/1.1\r\nHost: localhost\r\n\r\n", file.path));
        const std::string policy = field(other.receive(false), "Content-Security-Policy");
        // The rest of the policy is the same.
        EXPECT_EQ(policy, alone.substr(0, alone.rfind(' ')) + " https://a.example http://b.example:8443") << file.path;
    }
}

TEST(FrameAncestors, AreOriginsThatBrowsersCompareWith) {
    EXPECT_EQ(FrameAncestors().directive(), "frame-ancestors 'none'");
    EXPECT_EQ(FrameAncestors(std::vector<std::string>{}).directive(), "frame-ancestors 'none'");
    EXPECT_EQ(FrameAncestors({"https://A.example:1", "http://127.0.0.1:8080"}).directive(),
              "frame-ancestors https://A.example:1 http://127.0.0.1:8080");
    for (const std::string wrong :
         {"", "*", "'self'", "null", "https:", "https://*.example", "a.example", "https://a.example/page",
          "https://a.example; script-src *", "https://a.example https://b.example", "https://[::1]:8080"}) {
        try {
            const FrameAncestors ancestors({"https://a.example", wrong});
            FAIL() << wrong << " became " << ancestors.directive();
        } catch (const InvalidInput& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find("--web-frame-ancestors"), std::string::npos) << message;
            EXPECT_NE(message.find('"' + wrong + '"'), std::string::npos) << message;
        }
    }
}

TEST_F(ViewerPages, HaveTheirTypesAndAreKeptAsLongAsTheirNamesTell) {
    for (const viewer::File& file : viewer::files()) {
        const HttpAnswer answer = ask(std::string(file.path));
        EXPECT_EQ(answer.status, 200) << file.path;
        EXPECT_EQ(field(answer, "Content-Type"), file.content_type);
        EXPECT_EQ(field(answer, "Cache-Control"), file.hashed ? "public, max-age=31536000, immutable" : "no-cache")
            << file.path;
    }
    EXPECT_EQ(ask("/assets/none.js").status, 404);
}

TEST_F(ViewerPages, AreCompressedForThoseWhoTakeThat) {
    for (const viewer::File& file : viewer::files()) {
        const std::string path(file.path);
        const HttpAnswer small = ask(path, "Accept-Encoding: br, gzip;q=0.8\r\n");
        EXPECT_EQ(field(small, "Content-Encoding"), file.compressed ? "gzip" : "");
        EXPECT_EQ(small.body.size(), file.bytes.size());
        const HttpAnswer large = ask(path, "Accept-Encoding: gzip;q=0\r\n");
        EXPECT_EQ(field(large, "Content-Encoding"), "");
        EXPECT_EQ(field(large, "Vary"), "Accept-Encoding");
        EXPECT_TRUE(large.body == ask(path).body);
        if (file.compressed) {
            EXPECT_FALSE(large.body == small.body);
        }
    }
}

TEST_F(ViewerPages, AreNotSentAgainToThoseWhoHaveThem) {
    const HttpAnswer first = ask("/");
    const std::string tag = field(first, "ETag");
    ASSERT_FALSE(tag.empty());
    const HttpAnswer second = ask("/", "If-None-Match: \"other\", " + tag + "\r\n");
    EXPECT_EQ(second.status, 304);
    EXPECT_TRUE(second.body.empty());
    EXPECT_EQ(field(second, "ETag"), tag);
    EXPECT_EQ(ask("/", "If-None-Match: \"other\"\r\n").body, first.body);
}

TEST_F(ViewerPages, AnswerHeadWithTheHeaderAlone) {
    const HttpAnswer whole = ask("/");
    const HttpAnswer head = ask("/", "", "HEAD");
    EXPECT_EQ(head.status, 200);
    EXPECT_EQ(head.header, whole.header);
    EXPECT_EQ(ask("/").body, whole.body);
}

TEST(AcceptsGzip, WhereItIsNamedWithAWeight) {
    for (const char* yes : {"gzip", "br, gzip", "gzip;q=0.001", " gzip ; q=1", "deflate,gzip", "GZIP"})
        EXPECT_TRUE(accepts_gzip(yes)) << yes;
    for (const char* no : {"", "br", "gzip;q=0", "gzip; q=0.000", "xgzip", "identity, br", ",,;"})
        EXPECT_FALSE(accepts_gzip(no)) << no;
}

}  // namespace
}  // namespace meniscus::server::test
