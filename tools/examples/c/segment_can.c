/* Segments a mesh that the program makes itself, through the C interface: with a time limit, a bound on threads and
 * memory, and a progress callback. Returns 0 only if the three surfaces of a can were found. C99. */
#include <quadseg/quadseg.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { segments = 48, rows = 16, vertices = segments * (rows + 1) + 2, faces = 2 * segments * rows + 2 * segments };

static double positions[3 * vertices];
static uint32_t triangles[3 * faces];

static void make_can(void) {
    double* p = positions;
    uint32_t* t = triangles;
    for (int r = 0; r <= rows; ++r) {
        for (int s = 0; s < segments; ++s) {
            const double angle = 2 * 3.14159265358979323846 * s / segments;
            *p++ = cos(angle);
            *p++ = sin(angle);
            *p++ = 3.0 * r / rows;
        }
    }
    for (int end = 0; end <= 3; end += 3) {
        *p++ = 0;
        *p++ = 0;
        *p++ = end;
    }
    for (uint32_t s = 0; s < segments; ++s) {
        const uint32_t next = (s + 1) % segments;
        for (uint32_t r = 0; r < rows; ++r) {
            const uint32_t low = r * segments, high = low + segments;
            const uint32_t quad[6] = {low + s, low + next, high + next, low + s, high + next, high + s};
            for (int k = 0; k < 6; ++k) *t++ = quad[k];
        }
        const uint32_t last = rows * segments, bottom = vertices - 2, top = vertices - 1;
        const uint32_t lids[6] = {bottom, next, s, top, last + s, last + next};
        for (int k = 0; k < 6; ++k) *t++ = lids[k];
    }
}

static int32_t show_progress(const quadseg_progress* progress, void* user_data) {
    *(double*)user_data = progress->fraction;
    return 1; /* 0 would cancel */
}

static int failed(const char* what) {
    fprintf(stderr, "%s: %s\n", what, quadseg_last_error());
    return 1;
}

int main(void) {
    make_can();
    double fraction = 0;
    quadseg_context* context = NULL;
    if (quadseg_context_create(&context)) return failed("context");
    quadseg_context_set_time_limit(context, 60);
    quadseg_context_set_threads(context, 2);
    quadseg_context_set_memory_limit(context, UINT64_C(1) << 30);
    quadseg_context_set_progress(context, show_progress, &fraction);

    quadseg_mesh_view mesh = {sizeof mesh, 0, positions, vertices, triangles, faces, NULL};
    quadseg_options options;
    quadseg_options_init(&options, sizeof options);

    quadseg_segmentation* result = NULL;
    if (quadseg_segment(&mesh, &options, context, &result)) return failed("segment");
    quadseg_summary summary = {0};
    summary.struct_size = sizeof summary;
    if (quadseg_segmentation_summary(result, &summary)) return failed("summary");

    int32_t* labels = malloc((size_t)summary.labels * sizeof *labels);
    quadseg_region* regions = malloc((size_t)summary.regions * sizeof *regions);
    if (!labels || !regions) return 1;
    if (quadseg_segmentation_labels(result, labels, (size_t)summary.labels)) return failed("labels");
    if (quadseg_segmentation_regions(result, regions, sizeof *regions, (size_t)summary.regions)) {
        return failed("regions");
    }
    int planes = 0, cylinders = 0;
    for (uint64_t i = 0; i < summary.regions; ++i) {
        printf("region %d: %s, %llu faces, radius %.6g, rms %.2g\n", (int)regions[i].id,
               quadseg_surface_type_name(regions[i].type), (unsigned long long)regions[i].faces, regions[i].radius,
               regions[i].rms);
        planes += regions[i].type == QUADSEG_PLANE;
        cylinders += regions[i].type == QUADSEG_CYLINDER;
    }
    printf("the first face belongs to region %d; stopped: %s\n", (int)labels[0], quadseg_stop_name(summary.stop));

    /* A mistake, and what the library says about it. */
    mesh.face_count = 0;
    quadseg_segmentation* none = NULL;
    const quadseg_status status = quadseg_segment(&mesh, NULL, NULL, &none);
    printf("no faces: %s: %s\n", quadseg_status_name(status), quadseg_last_error());

    free(labels);
    free(regions);
    quadseg_segmentation_destroy(result);
    quadseg_context_destroy(context);
    return planes == 2 && cylinders == 1 && fraction > 0 && status == QUADSEG_EMPTY_MESH ? 0 : 1;
}
