// The reader of standard error, on which a command says what it does.
#pragma once

namespace meniscus::cli {

/// To be called after a line that is no warning and no error. Throws std::runtime_error once standard error is a pipe
/// that nobody reads any more, as in `2>&1 | head -1`. Programs that leave SIGPIPE alone end by it then; a command ends
/// what it has begun, and leaves no half of a file.
void require_listener();

}  // namespace meniscus::cli
