#include "attacks.hpp"

namespace meniscus::hostile {

std::span<const Attack> attacks() {
    static constexpr Attack all[] = {
        {"announcements", "frames announced as large as the limit, of which a byte comes now and then", announcements},
        {"cheap-frames", "eleven frames that pass the estimate and hold the device, at the defaults", cheap_frames},
        {"crowded-frames", "frames of a megabyte or less with all their particles in few places", crowded_frames},
        {"connections", "1100 and 5000 connections at 1024 descriptors, twenty times", connections},
        {"damaged-recording", "four bytes of a recording, changed at 400 places, one after the other",
         damaged_recording},
        {"garbled-requests", "3000 requests of bytes that are none, to every method", garbled_requests},
        {"greedy-names", "an uploader that takes all sessions, and deletes 300 behind a long frame", greedy_names},
        {"gzip-bomb", "512 MiB of zeros, compressed by gzip, without a token", gzip_bomb},
        {"half-open-calls", "500 calls that begin and send no message", half_open_calls},
        {"hostile-files", "files that the command line converts: bombs, and those that lead to other files",
         hostile_files},
        {"http-clients", "dripping headers, a request without a host, tags of a session that was replaced",
         http_clients},
        {"invisible-names", "names of sessions that look like another, or like none", invisible_names},
        {"killed-simulators", "300 simulators killed at random moments, under each policy, and ten that leave",
         killed_simulators},
        {"large-requests", "512 MiB in one message of callers that are admitted, three at a time", large_requests},
        {"large-sessions", "six sessions that take all the memory of reconstructions, beside ten small ones",
         large_sessions},
        {"proxied-strangers", "600,000 resets, and headers without an end, through the shipped proxies",
         proxied_strangers},
        {"restarts", "40 servers killed or ended, each back after 0.1 to 5 s", restarts},
        {"stalled-readers", "readers of a recording that take every place and read nothing", stalled_readers},
        {"starved-frames", "six sessions of small frames beside one that needs nine tenths of the bytes in flight",
         starved_frames},
        {"stops", "200 ends after watchers that were stalled, killed, or have vanished", stops},
        {"unread-requests", "512 MiB in one message, to every call, eleven at once, without a token", unread_requests},
    };
    return all;
}

}  // namespace meniscus::hostile
