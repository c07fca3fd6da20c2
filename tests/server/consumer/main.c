/* A simulation in C, as its build sees it: pkg-config, and nothing of C++. No server is there. */
#include <meniscus/meniscus.h>
#include <stdio.h>

int main(void) {
    meniscus_client* client = NULL;
    const meniscus_result result = meniscus_client_connect("127.0.0.1:1", NULL, &client);
    printf("%s: %s\n", meniscus_result_name(result), meniscus_error_message());
    return result == MENISCUS_UNAVAILABLE ? 0 : 1;
}
