#include "client.hpp"

#include "options.hpp"
#include "result.hpp"
#include "text_options/client_options.hpp"

using namespace meniscus::c;

meniscus_result meniscus_client_connect(const char* address, const meniscus_options* options,
                                        meniscus_client** client) {
    return guarded([&] {
        required(client, "client") = nullptr;
        auto reader = reader_of(options);
        const auto connection = meniscus::text_options::read_connection(reader);
        reader.finish();
        *client = new meniscus_client{meniscus::client::Client(&required(address, "address"), connection)};
        return MENISCUS_OK;
    });
}

void meniscus_client_destroy(meniscus_client* client) {
    delete client;
}

meniscus_result meniscus_client_delete_session(meniscus_client* client, const char* session_id) {
    return guarded([&] {
        required(client, "client").content.delete_session(&required(session_id, "session_id"));
        return MENISCUS_OK;
    });
}
