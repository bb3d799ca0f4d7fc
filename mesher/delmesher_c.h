/* delmesher in C: a surface in, a mesh out. A thin layer over delmesher.h, which says what
 * everything means; stable within a minor version.
 *
 * Nothing is thrown and nothing is printed. Every function takes NULL where it takes a result or
 * options, and then does nothing or answers 0. Objects of different threads are independent. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* "MAJOR.MINOR.PATCH" */
const char* delmesher_version(void);

/* A triangulated surface, which stays the caller's: n_vertices times x y z, n_triangles times three
 * numbers of vertices from 0, counter-clockwise seen from outside; a label for each triangle, or
 * NULL. Vertices of no triangle become vertices of the mesh. */
typedef struct {
  const double* vertices;
  size_t n_vertices;
  const uint32_t* triangles;
  size_t n_triangles;
  const int32_t* labels;
} delmesher_surface;

/* How a call ended. */
/* NOLINTBEGIN(readability-identifier-naming): as names of C have no scope */
typedef enum {
  DELMESHER_OK = 0,
  DELMESHER_INVALID_OPTIONS = 1,
  DELMESHER_INVALID_SURFACE = 2,
  DELMESHER_LIMIT_REACHED = 3,
  DELMESHER_INTERRUPTED = 4,
  DELMESHER_INTERNAL_ERROR = 5,
  DELMESHER_INVALID_MESH = 6
} delmesher_status;
/* NOLINTEND(readability-identifier-naming) */

/* Labels the faces of a surface without labels by its sharp edges: `labels` gets n_triangles of
 * them, 1, 2, ... A face grows over edges that bend by less than `degrees`, above 0 and at most 90.
 * DELMESHER_INVALID_OPTIONS: that is not so, or there are several labels already. */
delmesher_status delmesher_label_by_angle(const delmesher_surface* surface, double degrees,
                                          int32_t* labels);

/* Options by their names in docs/options.md, with _ for -. Switches are 0 or 1, and so is a choice
 * of two; planar is -1 for auto; paper_NAME is a choice of --as-paper. A call rejects options that
 * it does not use, and values out of range, with DELMESHER_INVALID_OPTIONS. */
struct delmesher_options;
typedef struct delmesher_options delmesher_options;
delmesher_options* delmesher_options_new(void); /* NULL if there is no memory */
void delmesher_options_free(delmesher_options* options);
/* 0, or -1 if there is no such option, if the value is not of its kind (a switch of 2, half a
 * thread), or if there is no memory. The last value of an option counts. */
int delmesher_options_set(delmesher_options* options, const char* name, double value);

/* The option size_field: n_sources times x y z size, of which a copy is taken. 0, or -1 if there is
 * no memory. */
int delmesher_options_size_field(delmesher_options* options, const double* sources,
                                 size_t n_sources);

/* A point that tells of the region around it, with the option regions: its name or NULL, its
 * longest edge or 0, and whether it is left out. 0, or -1 if there is no memory. */
int delmesher_options_region_point(delmesher_options* options, const double* xyz, const char* name,
                                   double max_edge, int is_hole);

/* Called several times a second by the thread that called the library. `done` is the fraction of
 * the phase, negative if unknown. Any answer but 0 ends the run, with DELMESHER_INTERRUPTED. */
typedef int (*delmesher_progress)(void* user, const char* phase, double done, uint64_t vertices);
void delmesher_options_progress(delmesher_options* options, delmesher_progress progress,
                                void* user);

/* `options` may be NULL: the defaults. The result is NULL only if there is no memory even for that.
 */
struct delmesher_result;
typedef struct delmesher_result delmesher_result;
delmesher_result* delmesher_tetrahedralize(const delmesher_surface* surface,
                                           const delmesher_options* options);
delmesher_result* delmesher_constrained_delaunay(const delmesher_surface* surface,
                                                 const delmesher_options* options);
void delmesher_result_free(delmesher_result* result);

delmesher_status delmesher_result_status(const delmesher_result* result);
/* One line that says what went wrong; empty if nothing did. */
const char* delmesher_result_message(const delmesher_result* result);

/* The mesh; empty unless the status is DELMESHER_OK. The arrays are the result's, and last as long
 * as it does. Each tetrahedron a b c d has det(b-a, c-a, d-a) > 0. */
size_t delmesher_result_vertices(const delmesher_result* result, const double** xyz);
/* Four numbers of vertices each; `inside` is 1 in the solid (all, unless the region is the hull).
 */
size_t delmesher_result_tetrahedra(const delmesher_result* result, const uint32_t** corners,
                                   const uint8_t** inside);
/* A number from 1 on for each tetrahedron, with the option regions = 1 (all); else nothing. */
size_t delmesher_result_regions(const delmesher_result* result, const int32_t** numbers);
/* What a region is called by a point in it; empty if it is not. */
const char* delmesher_result_region_name(const delmesher_result* result, int32_t number);
/* What a label is called that is of one side of a wall (the option split_walls = 1); else empty. */
const char* delmesher_result_wall_name(const delmesher_result* result, int32_t label);
/* The triangles that tile the surface: three numbers of vertices each, the label of the input, and
 * the facet. */
size_t delmesher_result_boundary(const delmesher_result* result, const uint32_t** corners,
                                 const int32_t** labels, const uint32_t** facets);

#ifdef __cplusplus
}
#endif
