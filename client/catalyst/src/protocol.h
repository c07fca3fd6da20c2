/* What Catalyst 2 asks of an implementation, and the functions of Conduit that it lends to one, declared here so that
 * nothing need be installed to build this library. libcatalyst.so, which loads it, has all of them: its Conduit lies
 * under names of its own, which begin with catalyst_conduit_.
 */
#ifndef MENISCUS_CATALYST_PROTOCOL_H
#define MENISCUS_CATALYST_PROTOCOL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A tree: an object or a list has children, a leaf has numbers or a text. */
typedef struct conduit_node_impl conduit_node;
typedef struct conduit_datatype_impl conduit_datatype;
typedef int64_t conduit_index_t;

/* 0: all is well. libcatalyst has numbers from 1 on for itself. */
enum catalyst_status {
    catalyst_status_ok = 0,
    catalyst_status_meniscus_first = 200,
    catalyst_status_meniscus_last = 299
};

/* What libcatalyst looks up by the name catalyst_api_impl. */
struct catalyst_impl {
    int version; /* 1 */
    enum catalyst_status (*initialize)(const conduit_node* params);
    enum catalyst_status (*execute)(const conduit_node* params);
    enum catalyst_status (*finalize)(const conduit_node* params);
    enum catalyst_status (*about)(conduit_node* params);
    enum catalyst_status (*results)(conduit_node* params);
};

int catalyst_conduit_node_has_path(const conduit_node* node, const char* path);
/* An error that ends the program where the path is not there. */
conduit_node* catalyst_conduit_node_fetch_existing(conduit_node* node, const char* path);
conduit_index_t catalyst_conduit_node_number_of_children(conduit_node* node);
conduit_node* catalyst_conduit_node_child(conduit_node* node, conduit_index_t index);
/* For the caller to free(). */
char* catalyst_conduit_node_name(const conduit_node* node);
char* catalyst_conduit_node_as_char8_str(conduit_node* node);
/* Where an element of a leaf lies, its offset and stride counted in. */
void* catalyst_conduit_node_element_ptr(conduit_node* node, conduit_index_t index);
void catalyst_conduit_node_set_path_char8_str(conduit_node* node, const char* path, const char* value);
void catalyst_conduit_node_set_path_int64(conduit_node* node, const char* path, int64_t value);

const conduit_datatype* catalyst_conduit_node_dtype(const conduit_node* node);
conduit_index_t catalyst_conduit_datatype_number_of_elements(const conduit_datatype* type);
/* Bytes from one element to the next. */
conduit_index_t catalyst_conduit_datatype_stride(const conduit_datatype* type);
int catalyst_conduit_datatype_endianness_matches_machine(const conduit_datatype* type);
int catalyst_conduit_datatype_is_char8_str(const conduit_datatype* type);
int catalyst_conduit_datatype_is_int8(const conduit_datatype* type);
int catalyst_conduit_datatype_is_int16(const conduit_datatype* type);
int catalyst_conduit_datatype_is_int32(const conduit_datatype* type);
int catalyst_conduit_datatype_is_int64(const conduit_datatype* type);
int catalyst_conduit_datatype_is_uint8(const conduit_datatype* type);
int catalyst_conduit_datatype_is_uint16(const conduit_datatype* type);
int catalyst_conduit_datatype_is_uint32(const conduit_datatype* type);
int catalyst_conduit_datatype_is_uint64(const conduit_datatype* type);
int catalyst_conduit_datatype_is_float32(const conduit_datatype* type);
int catalyst_conduit_datatype_is_float64(const conduit_datatype* type);

#ifdef __cplusplus
}
#endif

#endif /* MENISCUS_CATALYST_PROTOCOL_H */
