/* The same cube through the C interface. */
#include <delmesher_c.h>
#include <stdio.h>
#include <string.h>

static int calls = 0;

static int go_on(void* user, const char* phase, double done, uint64_t vertices) {
  (void)done;
  (void)vertices;
  ++calls;
  return strcmp(phase, (const char*)user) == 0; /* ends when this phase begins */
}

static int fail(const char* why) {
  fprintf(stderr, "c_consumer: %s\n", why);
  return 1;
}

int main(void) {
  double points[24];
  const uint32_t triangles[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  const int32_t labels[12] = {1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6};
  delmesher_surface cube = {points, 8, triangles, 12, labels};
  for (int corner = 0; corner < 8; ++corner) {
    for (int k = 0; k < 3; ++k) points[3 * corner + k] = corner >> k & 1;
  }
  int32_t by_angle[12] = {0};
  if (delmesher_label_by_angle(&cube, 30, by_angle) != DELMESHER_INVALID_OPTIONS) return fail("labelled twice");
  cube.labels = NULL;
  if (delmesher_label_by_angle(&cube, 91, by_angle) != DELMESHER_INVALID_OPTIONS) return fail("labelled by 91 degrees");
  if (delmesher_label_by_angle(&cube, 30, NULL) != DELMESHER_INVALID_SURFACE) return fail("labels for nobody");
  if (by_angle[0] != 0) return fail("labels although refused");
  if (delmesher_label_by_angle(&cube, 30, by_angle) != DELMESHER_OK) return fail("not labelled by angle");
  if (memcmp(by_angle, labels, sizeof labels) != 0) return fail("other labels by angle");
  cube.labels = by_angle;
  delmesher_options* options = delmesher_options_new();
  if (delmesher_options_set(options, "max_edge", 0.5) != 0) return fail("max_edge is not an option");
  const double sources[] = {0, 0, 0, 0.25, 1, 1, 1, 0.25};
  if (delmesher_options_size_field(options, sources, 2) != 0) return fail("no size field");
  if (delmesher_options_size_field(options, NULL, 1) != -1) return fail("a size field of nothing");
  if (delmesher_options_size_field(NULL, sources, 2) != -1) return fail("a size field of nobody");
  if (delmesher_options_set(options, "threads", 2) != 0) return fail("threads is not an option");
  if (delmesher_options_set(options, "max_egde", 1) != -1) return fail("max_egde is an option");
  if (delmesher_options_set(options, "threads", 1.5) != -1) return fail("one and a half threads");
  if (delmesher_options_set(options, "improve", 2) != -1) return fail("improved twice");
  if (delmesher_options_set(options, "order", 1) != -1) return fail("order is an option");
  if (delmesher_options_set(options, "paper_order", 0) != 0) return fail("paper_order is not an option");

  delmesher_result* result = delmesher_tetrahedralize(&cube, options);
  if (delmesher_result_status(result) != DELMESHER_OK) return fail(delmesher_result_message(result));
  const double* xyz = NULL;
  const uint32_t *corners = NULL, *facets = NULL, *sides = NULL;
  const uint8_t* inside = NULL;
  const int32_t* of_sides = NULL;
  const size_t vertices = delmesher_result_vertices(result, &xyz);
  const size_t tetrahedra = delmesher_result_tetrahedra(result, &corners, &inside);
  const size_t boundary = delmesher_result_boundary(result, &sides, &of_sides, &facets);
  double volume = 0;
  for (size_t t = 0; t < tetrahedra; ++t) {
    double e[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        if (corners[4 * t + i + 1] >= vertices) return fail("a corner is out of range");
        e[i][k] = xyz[3 * corners[4 * t + i + 1] + k] - xyz[3 * corners[4 * t] + k];
      }
    }
    const double six = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                       e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                       e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    if (!(six > 0) || inside[t] != 1) return fail("a tetrahedron is inverted or outside");
    volume += six / 6;
  }
  if (volume < 1 - 1e-12 || volume > 1 + 1e-12) return fail("another volume");
  if (boundary < 12 || of_sides[0] < 1 || of_sides[boundary - 1] > 6) return fail("other labels");
  delmesher_result_free(result);

  result = delmesher_constrained_delaunay(&cube, options);
  if (delmesher_result_status(result) != DELMESHER_INVALID_OPTIONS) return fail("cdt took max_edge");
  if (strstr(delmesher_result_message(result), "max_edge") == NULL) return fail("another option than max_edge");
  delmesher_result_free(result);
  delmesher_options* hull = delmesher_options_new();
  if (delmesher_options_set(hull, "threads", 2) != 0) return fail("threads is not an option");
  result = delmesher_constrained_delaunay(&cube, hull);
  if (delmesher_result_status(result) != DELMESHER_OK) return fail(delmesher_result_message(result));
  delmesher_result_free(result);
  delmesher_options_free(hull);

  delmesher_options_progress(options, go_on, "refine");
  result = delmesher_tetrahedralize(&cube, options);
  if (calls == 0 || delmesher_result_status(result) != DELMESHER_INTERRUPTED) return fail("went on");
  delmesher_result_free(result);

  delmesher_options* regions = delmesher_options_new();
  const double middle[3] = {0.5, 0.5, 0.5};
  if (delmesher_options_set(regions, "regions", 1) != 0) return fail("regions is no option");
  if (delmesher_options_set(regions, "split_walls", 1) != 0) return fail("split_walls is no option");
  if (delmesher_options_region_point(regions, middle, "core", 0, 0) != 0) return fail("no region point");
  if (delmesher_options_region_point(regions, NULL, "core", 0, 0) != -1) return fail("a region point nowhere");
  result = delmesher_tetrahedralize(&cube, regions);
  if (delmesher_result_status(result) != DELMESHER_OK) return fail(delmesher_result_message(result));
  if (strcmp(delmesher_result_region_name(result, 1), "core") != 0) return fail("the region has another name");
  if (*delmesher_result_region_name(result, 2) != 0 || *delmesher_result_wall_name(result, 7) != 0) return fail("a name of nothing");
  delmesher_result_free(result);
  delmesher_options_free(regions);

  cube.n_triangles = 11;
  result = delmesher_tetrahedralize(&cube, NULL);
  if (delmesher_result_status(result) != DELMESHER_INVALID_SURFACE) return fail("an open cube was meshed");
  if (strstr(delmesher_result_message(result), "open edge") == NULL) return fail("nothing said of the open edge");
  if (delmesher_result_vertices(result, &xyz) != 0 || xyz != NULL) return fail("a mesh of an open cube");
  delmesher_result_free(result);
  delmesher_result_free(NULL);
  delmesher_options_free(options);
  printf("C, version %s: %zu tetrahedra\n", delmesher_version(), tetrahedra);
  return 0;
}
