// A folder with very many recordings, which somebody asks for again and again.
#include "recording/recording_service.hpp"

namespace meniscus::server::test {
namespace {

/// Thousands of recordings of somebody else: to look through them takes long, an answer without them does not.
class ManyRecordings : public RecordingService {
protected:
    ManyRecordings() {
        std::filesystem::create_directory(folder_ / id_);
        const std::string begin = recording_begin(id_, settings(), 0, "ada");
        for (std::uint32_t i = 1; i <= 3000; ++i) std::ofstream(folder_ / id_ / recording_file_name(i)) << begin;
        ServerOptions closed = options();
        closed.tokens = tokens_.write("tokens", "uploader ben " + token_ + "\n");
        closed.limits.recording_readers = 0;  // a call's place is free a moment after its client has its status
        server_.emplace(closed);
        connection_.emplace(server_->address(), client::ConnectionOptions{.token = token_});
        look();  // into each file, once
    }

    /// Seconds of one call of ListRecordings.
    double look() const {
        const auto begun = std::chrono::steady_clock::now();
        grpc::ClientContext context;
        connection_->add_metadata(context, {});
        v1::ListRecordingsResponse response;
        EXPECT_TRUE(connection_->recordings->ListRecordings(&context, {}, &response).ok());
        EXPECT_EQ(response.recordings_size(), 0);
        return seconds_since(begun);
    }
    static double seconds_since(std::chrono::steady_clock::time_point begun) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    }

    const TestFolder tokens_;
    const std::string token_ = "token-of-ben-0123456789";
    const std::string id_ = client::new_session_id();
    std::optional<Server> server_;
    std::optional<client::Connection> connection_;
};

/// Calls of ListRecordings that wait for their answers at the same time.
class Looks {
public:
    Looks(const client::Connection& connection, std::size_t count) : calls_(count) {
        for (Call& call : calls_) {
            connection.add_metadata(call.context, {});
            connection.recordings->async()->ListRecordings(&call.context, &request_, &call.response,
                                                           [&call](const grpc::Status& status) { call.end(status); });
        }
    }
    std::vector<grpc::StatusCode> ends() {
        std::vector<grpc::StatusCode> codes;
        for (Call& call : calls_) codes.push_back(call.ended.get_future().get());
        return codes;
    }
    void cancel() {
        for (Call& call : calls_) call.context.TryCancel();
    }

private:
    struct Call {
        void end(const grpc::Status& status) { ended.set_value(status.error_code()); }
        grpc::ClientContext context;
        v1::ListRecordingsResponse response;
        std::promise<grpc::StatusCode> ended;
    };
    const v1::ListRecordingsRequest request_;
    std::deque<Call> calls_;
};

TEST_F(ManyRecordings, AreLookedThroughOnceForAllWhoWait) {
    const double one = look();
    const auto begun = std::chrono::steady_clock::now();
    Looks looks(*connection_, 500);
    for (const grpc::StatusCode code : looks.ends()) EXPECT_EQ(code, grpc::StatusCode::OK);
    EXPECT_LT(seconds_since(begun), 100 * one);
}

TEST_F(ManyRecordings, AreNotLookedThroughForCallsThatHaveBeenCanceled) {
    const double one = look();
    const auto begun = std::chrono::steady_clock::now();
    Looks looks(*connection_, 500);
    looks.cancel();
    looks.ends();
    look();
    EXPECT_LT(seconds_since(begun), 100 * one);
}

TEST_F(ManyRecordings, DoNotDelayTheServersEnd) {
    const double one = look();
    Looks looks(*connection_, 500);
    const auto begun = std::chrono::steady_clock::now();
    server_.reset();
    EXPECT_LT(seconds_since(begun), 1 + 100 * one);
    looks.ends();
}

TEST_F(ManyRecordings, AreNotLookedThroughForOneThatIsNotThere) {
    const double one = look();
    const auto begun = std::chrono::steady_clock::now();
    for (int i = 0; i < 200; ++i) {
        grpc::ClientContext context;
        connection_->add_metadata(context, id_);
        const auto call = connection_->recordings->ReadRecording(&context, request_for(id_, 4000));
        v1::WatchResponse ignored;
        EXPECT_FALSE(call->Read(&ignored));
        EXPECT_EQ(call->Finish().error_code(), grpc::StatusCode::NOT_FOUND);
    }
    EXPECT_LT(seconds_since(begun), 100 * one);
}

}  // namespace
}  // namespace meniscus::server::test
