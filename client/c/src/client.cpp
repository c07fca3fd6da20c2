#include "client.hpp"

#include "options.hpp"
#include "result.hpp"

using namespace meniscus::c;

meniscus_result meniscus_client_connect(const char* address, const meniscus_options* options,
                                        meniscus_client** client) {
    return guarded([&] {
        required(client, "client") = nullptr;
        OptionReader reader(options);
        meniscus::client::ConnectionOptions connection;
        reader.read("tls-ca", connection.ca_file);
        reader.read("tls-cert", connection.certificate_file);
        reader.read("tls-key", connection.key_file);
        reader.read("tls-server-name", connection.server_name);
        reader.read("token", connection.token);
        reader.read("insecure", connection.insecure);
        reader.read("timeout", connection.timeout);
        reader.read("wait", connection.wait);
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
