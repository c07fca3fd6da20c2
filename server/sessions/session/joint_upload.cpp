#include "sessions/session/joint_upload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/seconds.hpp"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/session/joint_uploads.hpp"
#include "sessions/session/session.hpp"

namespace meniscus::server {

namespace {

std::string name_of_part(std::size_t part, std::size_t parts) {
    return fmt::format("part {} of {}", part, parts);
}

/// The same error, of the part that it is about.
std::exception_ptr named(const std::exception_ptr& error, const std::string& part) {
    const auto text = [&](const std::exception& of) { return fmt::format("{}: {}", part, of.what()); };
    try {
        std::rethrow_exception(error);
    } catch (const InvalidInput& of) {
        return std::make_exception_ptr(InvalidInput(text(of)));
    } catch (const LimitReached& of) {
        return std::make_exception_ptr(LimitReached(of.limit(), text(of)));
    } catch (const LimitExceeded& of) {
        return std::make_exception_ptr(LimitExceeded(text(of)));
    } catch (...) {
        return error;
    }
}

/// Throws InvalidInput if a part says something else about the frames than those before it.
void require_equal(const UploadOptions& options, const UploadOptions& first, std::uint32_t part) {
    const auto require = [&](const char* what, auto is, auto of_first) {
        if (is != of_first)
            throw InvalidInput(fmt::format("part {} says {} {}, the parts before it {}; it is the same for all parts",
                                           part, what, is, of_first));
    };
    require("frames of", name_of(options.frames), name_of(first.frames));
    require("parts", options.parts, first.parts);
    require("policy", static_cast<int>(options.policy), static_cast<int>(first.policy));
    require("nth", options.nth, first.nth);
    require("reconnect_seconds", seconds_of(options.reconnect), seconds_of(first.reconnect));
}

}  // namespace

std::shared_ptr<JointUpload> JointUpload::open(const std::shared_ptr<Session>& session, const UploadOptions& options,
                                               std::uint32_t part, const std::weak_ptr<PartStream>& stream) {
    JointUploads& all = session->joint_uploads();
    const std::lock_guard lock(all.mutex);
    if (auto newest = all.newest.lock(); options.parts > 1 && newest && newest->options_.run_id == options.run_id)
        if (newest->take_part(options, part, stream)) return newest;
    auto made = std::make_shared<JointUpload>(session, options.parts);
    made->make_upload(options);
    // Before the session, which may end it at once, has it.
    made->take_part(options, part, stream);
    session->open_upload(made->upload_);
    std::set<std::uint32_t>& finished = made->upload_->run->finished_parts;
    // Once all have ended well, a stream that resumes none is the first of others of all parts.
    if (finished.size() == options.parts && !options.resumes) finished.clear();
    for (const std::uint32_t other : finished) made->go_on_without(other);
    all.newest = made;
    return made;
}

void JointUpload::make_upload(const UploadOptions& options) {
    const auto weak = weak_from_this();
    options_ = options;
    UploadOptions of_all = options;
    of_all.receive_meshes = false;
    upload_ = std::make_shared<Upload>(
        of_all,
        [weak](std::size_t part) {
            if (const auto self = weak.lock())
                if (const auto stream = self->stream_of(part)) stream->wake();
        },
        [weak] {
            if (const auto self = weak.lock()) self->end_between_frames(std::make_exception_ptr(shutting_down()));
        },
        [weak](const std::exception_ptr& error) {
            if (const auto self = weak.lock()) self->end_with(error);
        });
    upload_->missing_parts = options.parts;
}

bool JointUpload::take_part(const UploadOptions& options, std::uint32_t part, const std::weak_ptr<PartStream>& stream) {
    bool comes_again = false;
    {
        const std::lock_guard lock(mutex_);
        if (ended_ || upload_->output.finished()) return false;
        require_equal(options, options_, part);
        comes_again = parts_[part].is_present;
        if (comes_again && !upload_->run->has_begun)
            throw Refusal(Refusal::Kind::failed_precondition,
                          fmt::format("{} uploads to session {} already; each part is sent by one stream",
                                      name_of_part(part, parts_.size()), session_->id()));
        if (!comes_again) {
            if (parts_[part].state == State::absent) --upload_->missing_parts;
            parts_[part] = {.state = State::busy, .is_present = true, .stream = stream, .announced = {}};
            ++present_;
        }
    }
    if (comes_again) {
        break_off(fmt::format("{} has come again, over another stream", name_of_part(part, parts_.size())));
        return false;
    }
    if (part == 0) {
        upload_->options.receive_meshes = options.receive_meshes;
        upload_->options.normal_bits = options.normal_bits;
        upload_->options.codec = options.codec;
        upload_->options.spray = options.spray;
        upload_->options.attributes = options.attributes;
    }
    return true;
}

void JointUpload::ready(std::uint32_t part) {
    std::shared_ptr<PartStream> reads_on;
    {
        const std::lock_guard lock(mutex_);
        Part& of = parts_[part];
        of.state = State::ready;
        // One that comes again, though it had ended well before, finds the others at their next frame.
        if (!ended_ && input_ != nullptr) {
            of.state = State::reading;
            reads_on = of.stream.lock();
        }
    }
    if (reads_on)
        reads_on->read_next();
    else
        request_input();
}

void JointUpload::request_input() {
    {
        const std::lock_guard lock(mutex_);
        if (ended_ || input_requested_ || !has(State::ready) || !all_that_send_are(State::ready)) return;
        input_requested_ = true;
    }
    // What waits in the upload holds neither this nor the session, which has the upload.
    upload_->unreported_drops.when_below_limit([weak = weak_from_this()] {
        if (const auto self = weak.lock())
            self->session_->request_input([weak](InputFrame& input) {
                const auto locked = weak.lock();
                return locked && locked->use_input(input);
            });
    });
}

bool JointUpload::use_input(InputFrame& input) {
    std::vector<std::shared_ptr<PartStream>> ready;
    {
        const std::lock_guard lock(mutex_);
        if (ended_) return false;
        input_requested_ = false;
        input_ = &input;
        for (Part& part : parts_) {
            if (part.state != State::ready) continue;
            part.state = State::reading;
            ready.push_back(part.stream.lock());
        }
    }
    for (const auto& stream : ready)
        if (stream) stream->read_next();
    return true;
}

bool JointUpload::enter() {
    const std::lock_guard lock(mutex_);
    if (ended_) return false;
    ++working_;
    return true;
}

void JointUpload::leave() {
    InputFrame* unused = nullptr;
    {
        const std::lock_guard lock(mutex_);
        if (--working_ == 0 && ended_) unused = std::exchange(input_, nullptr);
    }
    if (unused != nullptr) session_->return_input(*unused);
}

void JointUpload::begin(std::uint32_t part, FramePart announced) {
    {
        const std::lock_guard lock(mutex_);
        parts_[part].announced = std::move(announced);
        parts_[part].state = State::begun;
    }
    resolve();
}

void JointUpload::resolve() {
    std::uint64_t newest = 0;
    std::vector<std::shared_ptr<PartStream>> behind;
    {
        const std::lock_guard lock(mutex_);
        const bool all_have_begun = all_that_send_are(State::begun);
        upload_->waits_for_parts = (has(State::begun) || has(State::closed)) && !all_have_begun;
        if (ended_ || !has(State::begun) || !all_have_begun) return;
        for (const Part& part : parts_)
            if (part.state == State::begun) newest = std::max(newest, part.announced.index);
        // A part that sends no more has gone past all frames. From here on no other thread finds all parts decided.
        const bool no_more = has(State::closed);
        for (Part& part : parts_) {
            if (part.state == State::closed || (!no_more && part.announced.index == newest)) continue;
            part.state = State::passing_over;
            behind.push_back(part.stream.lock());
        }
        if (behind.empty())
            for (Part& part : parts_) part.state = State::sending;
    }
    try {
        if (behind.empty()) {
            session_->admit_frame(newest);
            return begin_frame_of_all();
        }
        for (const auto& stream : behind)
            if (stream) stream->begun(std::nullopt);
    } catch (...) {
        end_with(std::current_exception());
    }
}

void JointUpload::begin_frame_of_all() {
    std::vector<FramePart> announced;
    for (const Part& part : parts_) announced.push_back(part.announced);  // nobody changes it now
    const auto pieces = begin_frame(announced, session_->limits(), *input_);
    std::size_t arriving = 0;
    for (const FramePart& part : announced) arriving += arriving_bytes(part);
    std::vector<std::shared_ptr<PartStream>> all;
    {
        const std::lock_guard lock(mutex_);
        in_frame_ = true;
        arrived_ = 0;
        kept_bytes_ = 0;
        for (const auto& of_part : pieces)
            for (const FramePiece& piece : of_part)
                if (piece.kept) kept_bytes_ += piece.end - piece.begin;
        all = streams();
    }
    upload_->run->has_begun = true;
    upload_->pace.begin(announced.front().index, arriving);
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i]) all[i]->begun(pieces[i]);
}

bool JointUpload::book(std::size_t bytes, std::function<void()> booked) {
    const std::size_t arrived = arrived_.fetch_add(bytes) + bytes;
    return input_->book(arrived == kept_bytes_ ? input_->bytes.size() : arrived, std::move(booked));
}

void JointUpload::end(std::uint32_t part) {
    std::shared_ptr<PartStream> reads_on;
    std::uint64_t index = 0;
    {
        const std::lock_guard lock(mutex_);
        Part& of = parts_[part];
        index = of.announced.index;
        if (of.state == State::passing_over) {
            of.state = State::reading;
            reads_on = of.stream.lock();
        } else {
            of.state = State::ready;
            if (!all_that_send_are(State::ready)) return;
        }
    }
    if (reads_on == nullptr) return submit();
    session_->report_incomplete(upload_, part, index);
    // What the upload keeps must not keep the stream, which has the upload.
    upload_->unreported_drops.when_below_limit([weak = std::weak_ptr(reads_on)] {
        if (const auto stream = weak.lock()) stream->read_next();
    });
}

void JointUpload::submit() {
    InputFrame* complete = nullptr;
    {
        const std::lock_guard lock(mutex_);
        complete = std::exchange(input_, nullptr);
        in_frame_ = false;
    }
    complete->received_at = std::chrono::steady_clock::now();
    upload_->pace.end();
    session_->submit(upload_, *complete);
    std::exception_ptr error;
    {
        const std::lock_guard lock(mutex_);
        error = ends_with_;
    }
    if (error)
        end_with(error);
    else
        request_input();
}

void JointUpload::close(std::uint32_t part) {
    bool all = false;
    {
        const std::lock_guard lock(mutex_);
        parts_[part].state = State::closed;
        all = closed_ = all_that_send_are(State::closed);
    }
    if (all)
        end_with(nullptr);
    else
        resolve();
}

void JointUpload::lose(std::uint32_t part) {
    break_off(fmt::format("{} has broken off", name_of_part(part, parts_.size())));
}

void JointUpload::move() {
    upload_->moves = true;
    end_between_frames(std::make_exception_ptr(moved()));
}

void JointUpload::fail(std::uint32_t part, const std::exception_ptr& error) {
    end_with(parts_.size() > 1 ? named(error, name_of_part(part, parts_.size())) : error);
}

void JointUpload::end_with(const std::exception_ptr& error) {
    if (stop_reading()) session_->end_upload(upload_, error);
}

void JointUpload::end_between_frames(const std::exception_ptr& error) {
    {
        const std::lock_guard lock(mutex_);
        ends_with_ = error;
        if (in_frame_) return;
    }
    end_with(error);
}

bool JointUpload::stop_reading() {
    InputFrame* unused = nullptr;
    std::vector<std::shared_ptr<PartStream>> all;
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(ended_, true)) return false;
        // Now, and not with the calls' ends: a simulator that reads nothing could hold them back.
        if (working_ == 0) unused = std::exchange(input_, nullptr);
        all = streams();
    }
    if (unused != nullptr) session_->return_input(*unused);
    for (const auto& stream : all)
        if (stream) stream->stop_reading();
    return true;
}

void JointUpload::break_off(const std::string& reason) {
    const auto error = std::make_exception_ptr(Refusal(
        Refusal::Kind::aborted, fmt::format("{}: the frames without an answer are dropped for all parts", reason)));
    // First, so that nothing is put into it any more. Where it has finished meanwhile, the others still take their
    // answers.
    if (!upload_->output.abort_unless_finished(error)) return;
    session_->cancel_upload(upload_, UploadEnd::vanished);
    end_with(error);
}

void JointUpload::done(std::uint32_t part, UploadEnd end) {
    bool all = false;
    bool has_finished = false;
    {
        const std::lock_guard lock(mutex_);
        has_finished = closed_ && end == UploadEnd::answered && !upload_->output.aborted();
        if (end == UploadEnd::vanished) end_ = end;
        all = ++done_ == present_;
        end = end_;
    }
    if (has_finished && parts_.size() > 1) {
        JointUploads& joints = session_->joint_uploads();
        const std::lock_guard lock(joints.mutex);
        upload_->run->finished_parts.insert(part);
        // The others may have resumed the run already, for the answers that they miss.
        if (const auto newest = joints.newest.lock(); newest && newest->upload_->run == upload_->run)
            newest->go_on_without(part);
    }
    if (parts_.size() > 1 && end == UploadEnd::vanished)
        break_off(fmt::format("{} has broken off", name_of_part(part, parts_.size())));
    if (all) session_->cancel_upload(upload_, end);
}

void JointUpload::go_on_without(std::uint32_t part) {
    {
        const std::lock_guard lock(mutex_);
        if (part >= parts_.size() || parts_[part].state != State::absent) return;
        parts_[part].state = State::closed;
        --upload_->missing_parts;
    }
    request_input();
}

std::shared_ptr<PartStream> JointUpload::stream_of(std::size_t part) const {
    const std::lock_guard lock(mutex_);
    return parts_[part].stream.lock();
}

bool JointUpload::all_that_send_are(State state) const {
    return std::ranges::all_of(parts_,
                               [&](const Part& part) { return part.state == state || part.state == State::closed; });
}

bool JointUpload::has(State state) const {
    return std::ranges::any_of(parts_, [&](const Part& part) { return part.state == state; });
}

std::vector<std::shared_ptr<PartStream>> JointUpload::streams() const {
    std::vector<std::shared_ptr<PartStream>> all;
    for (const Part& part : parts_) all.push_back(part.stream.lock());
    return all;
}

}  // namespace meniscus::server
