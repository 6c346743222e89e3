/// \file quadseg.h
/// The C interface of quadseg: C99, for anything that can call C. Nothing of C++ crosses it: no exception, no type, no
/// memory that the other side would have to free, but by the functions here.
///
/// Rules, the same for every function:
/// - What can fail returns a quadseg_status. On failure quadseg_last_error() has a sentence for the calling thread, and
///   no output has been touched, except that handles to be created are NULL.
/// - Arrays belong to the caller. Sizes are stated in elements; a buffer that is too small is QUADSEG_BUFFER_TOO_SMALL
///   and is left alone.
/// - A struct begins with struct_size = sizeof(the struct), as the caller's compiler sees it. A program made for an
///   older header goes on working: fields are only ever appended.
/// - Functions may be called from any thread. A handle may be read by several threads at once; a context may serve
///   several calls at once, and quadseg_context_cancel() may come from any thread or a signal handler.
/// - Nothing is printed, no signal is handled, the process is never ended.
#ifndef QUADSEG_QUADSEG_H
#define QUADSEG_QUADSEG_H

#include <quadseg/export.h>

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// ---- Errors

typedef int32_t quadseg_status;
enum {
    QUADSEG_OK = 0,
    QUADSEG_INVALID_ARGUMENT = 1,  ///< an option out of range, a null pointer, arrays of the wrong shape
    QUADSEG_INVALID_MESH = 2,      ///< index out of range, non-finite coordinate; the text names the face or vertex
    QUADSEG_EMPTY_MESH = 3,        ///< no face has an area
    QUADSEG_FILE_OPEN = 4,         ///< missing file, directory, no permission
    QUADSEG_FILE_FORMAT = 5,       ///< contents do not follow the format; the text names line or byte
    QUADSEG_FILE_WRITE = 6,        ///< disk full, read-only folder
    QUADSEG_CANCELLED = 7,         ///< cancelled or out of time before there was any partial result
    QUADSEG_MEMORY_LIMIT = 8,      ///< would need more than quadseg_context_set_memory_limit() allows
    QUADSEG_INTERNAL = 9,          ///< a defect of ours
    QUADSEG_OUT_OF_MEMORY = 10,    ///< an allocation failed; everything allocated by the call is freed
    QUADSEG_BUFFER_TOO_SMALL = 11  ///< the text says how many elements are needed
};

/// What the last failed call of this thread had to say: what, where, and what to do. Empty when none failed yet. Valid
/// until the next failing call of this thread. Never null.
QUADSEG_API const char* quadseg_last_error(void);
/// "ok", "invalid_argument" … "unknown" for other numbers. Never null.
QUADSEG_API const char* quadseg_status_name(quadseg_status status);
/// Of the library that is loaded: "0.1.0".
QUADSEG_API const char* quadseg_version(void);

// ---- Context: how a caller watches, bounds and stops a call

typedef struct quadseg_context quadseg_context;

enum {
    QUADSEG_PHASE_READ = 0,
    QUADSEG_PHASE_PREPARE = 1,
    QUADSEG_PHASE_COARSE = 2,
    QUADSEG_PHASE_FINE = 3,
    QUADSEG_PHASE_POST = 4,
    QUADSEG_PHASE_WRITE = 5
};

typedef struct quadseg_progress {
    uint32_t struct_size;
    int32_t phase;     ///< QUADSEG_PHASE_…
    double fraction;   ///< of the whole call, 0 to 1, never falls during one call
    uint64_t regions;  ///< current number of regions, 0 while there are none
    double energy;     ///< current energy in the unit cube, 0 while unknown
} quadseg_progress;

/// Returning 0 cancels the call, anything else goes on. Called one at a time, at most about 50 times a second, from a
/// thread that works on the call: keep it short. Must not throw or longjmp.
typedef int32_t (*quadseg_progress_function)(const quadseg_progress* progress, void* user_data);

/// A context without any limit. Destroy it when no call uses it any more; null is allowed there.
QUADSEG_API quadseg_status quadseg_context_create(quadseg_context** context);
QUADSEG_API void quadseg_context_destroy(quadseg_context* context);
/// Stops the calls that use this context soon (aim: 50 ms). For good: a cancelled context stays cancelled.
QUADSEG_API void quadseg_context_cancel(quadseg_context* context);
/// 1 or 0.
QUADSEG_API int32_t quadseg_context_cancelled(const quadseg_context* context);
/// Deadline `seconds` (> 0) from now: quadseg_segment() then returns its best partial result, marked.
QUADSEG_API quadseg_status quadseg_context_set_time_limit(quadseg_context* context, double seconds);
/// At most so many threads, the caller's included; 0: one a core.
QUADSEG_API quadseg_status quadseg_context_set_threads(quadseg_context* context, int32_t threads);
/// A call that would need more than so many bytes (estimated from its input) refuses at once; 0: no limit.
QUADSEG_API quadseg_status quadseg_context_set_memory_limit(quadseg_context* context, uint64_t bytes);
/// Null takes the callback off. Not while a call runs.
QUADSEG_API quadseg_status quadseg_context_set_progress(quadseg_context* context, quadseg_progress_function function,
                                                        void* user_data);

// ---- Meshes

/// The caller's arrays, or those of a quadseg_mesh; nothing is copied. They must outlive the call.
typedef struct quadseg_mesh_view {
    uint32_t struct_size;
    uint32_t reserved;        ///< 0
    const double* positions;  ///< 3 · vertex_count: x, y, z a vertex, any unit
    uint64_t vertex_count;
    const uint32_t* triangles;  ///< 3 · face_count vertex indices, counter-clockwise seen from outside
    uint64_t face_count;
    const uint32_t* polygons;  ///< null, or face_count: the polygon that a triangle was cut from
} quadseg_mesh_view;

/// A mesh that was read from a file.
typedef struct quadseg_mesh quadseg_mesh;

/// Reads OFF, OBJ, PLY or STL; faces keep the order of the file. `context` may be null.
QUADSEG_API quadseg_status quadseg_mesh_read(const char* path, quadseg_context* context, quadseg_mesh** mesh);
QUADSEG_API void quadseg_mesh_destroy(quadseg_mesh* mesh);
/// Points `view` (struct_size set) into the mesh: valid while the mesh lives.
QUADSEG_API quadseg_status quadseg_mesh_get_view(const quadseg_mesh* mesh, quadseg_mesh_view* view);

/// What a check of a mesh found; counts are of the input. See MeshReport in mesh.h.
typedef struct quadseg_mesh_report {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t faces, vertices, components;
    uint64_t border_edges, non_manifold_edges, non_manifold_vertices, isolated_vertices;
    uint64_t degenerate_faces, duplicate_faces, flipped_faces, unorientable_edges, stitched_edges;
    uint64_t feature_edges;
    double diagonal;  ///< of the bounding box, input unit
    double area;      ///< input unit squared
    double offset;    ///< of the box centre from the origin, in diagonals
    double box_min[3], box_max[3];
} quadseg_mesh_report;

/// Checks a mesh without segmenting it. Edges sharper than feature_degrees count as features; ≤ 0: none do.
QUADSEG_API quadseg_status quadseg_inspect(const quadseg_mesh_view* mesh, double feature_degrees,
                                           quadseg_context* context, quadseg_mesh_report* report);

// ---- Options

enum { QUADSEG_PRESET_STANDARD = 0, QUADSEG_PRESET_PAPER = 1 };
enum {
    QUADSEG_METHOD_QUADRIC = 0,
    QUADSEG_METHOD_VSA_L21 = 1,
    QUADSEG_METHOD_VSA_L2 = 2,
    QUADSEG_METHOD_HYBRID = 3,
    QUADSEG_METHOD_QUADRIC_L2 = 4,
    QUADSEG_METHOD_QUADRIC_GRADIENT = 5,
    QUADSEG_METHOD_HIERARCHICAL = 6
};

/// See Options in options.h for the meaning and range of every field. Lengths are relative to the diagonal of the
/// bounding box, angles in degrees. Fill it by quadseg_options_init(), then change what you want changed.
typedef struct quadseg_options {
    uint32_t struct_size;
    int32_t preset;                                        ///< QUADSEG_PRESET_…
    int32_t method;                                        ///< QUADSEG_METHOD_…, preset paper
    int32_t smooth, project, project_joint, regularities;  ///< 0 or 1
    int32_t smoothing_band;
    double smoothing_lambda;
    uint64_t regions;      ///< wanted, 0: found by the method itself
    double tolerance;      ///< largest RMS distance, 0: from the data
    double detail;         ///< > 0
    double feature_angle;  ///< degrees; < 0: as the preset sees fit
    double weight;         ///< ω of the energy
    uint64_t seed;
    int64_t coarse;  ///< faces of a simplified mesh to begin with, 0: none, −1: automatic
    int32_t paper_lloyd_iterations, paper_teleportations;
    int32_t paper_merging, paper_teleportation;  ///< 0 or 1
    double paper_convergence, paper_plane_tolerance, paper_merge_tolerance, paper_energy_threshold;
    uint64_t paper_initial_regions, paper_maximum_regions;
} quadseg_options;

/// Writes the defaults into the first struct_size bytes: quadseg_options_init(&options, sizeof options).
QUADSEG_API quadseg_status quadseg_options_init(quadseg_options* options, size_t struct_size);

// ---- Segmentation

typedef struct quadseg_segmentation quadseg_segmentation;

/// Segments a mesh. `options` null: defaults; `context` null: no limits. At a deadline or when cancelled the result is
/// the best so far and its summary says `partial`. Same input and options give the same result at any thread count.
QUADSEG_API quadseg_status quadseg_segment(const quadseg_mesh_view* mesh, const quadseg_options* options,
                                           quadseg_context* context, quadseg_segmentation** segmentation);
QUADSEG_API void quadseg_segmentation_destroy(quadseg_segmentation* segmentation);

enum {
    QUADSEG_STOP_CONVERGED = 0,
    QUADSEG_STOP_REGIONS = 1,
    QUADSEG_STOP_TOLERANCE = 2,
    QUADSEG_STOP_MAXIMUM = 3,
    QUADSEG_STOP_DEADLINE = 4,
    QUADSEG_STOP_CANCELLED = 5
};

typedef struct quadseg_summary {
    uint32_t struct_size;
    int32_t stop;     ///< QUADSEG_STOP_…
    int32_t partial;  ///< 1: stopped by deadline or cancellation
    int32_t threads;  ///< that could take part
    uint64_t labels;  ///< elements of each array below: faces of the input
    uint64_t regions, unlabelled, merges, energies, regularities;
    uint64_t projected;  ///< doubles: 3 a vertex, or 0
    double energy_total, energy_distance, energy_normal;
    double rms, max;  ///< distances of the vertices to their surfaces, relative to the diagonal
    double noise;     ///< of the vertices, relative to the diagonal
    double seconds_prepare, seconds_coarse, seconds_fine, seconds_post, seconds_total;
    uint64_t peak_bytes;
} quadseg_summary;

QUADSEG_API quadseg_status quadseg_segmentation_summary(const quadseg_segmentation* segmentation,
                                                        quadseg_summary* summary);
QUADSEG_API quadseg_status quadseg_segmentation_report(const quadseg_segmentation* segmentation,
                                                       quadseg_mesh_report* report);
/// The region of each face, in input order; −1 for faces listed as unlabelled. `capacity` ≥ summary.labels.
QUADSEG_API quadseg_status quadseg_segmentation_labels(const quadseg_segmentation* segmentation, int32_t* labels,
                                                       size_t capacity);
/// Faces without a label. `capacity` ≥ summary.unlabelled.
QUADSEG_API quadseg_status quadseg_segmentation_unlabelled(const quadseg_segmentation* segmentation, uint32_t* faces,
                                                           size_t capacity);

enum {
    QUADSEG_PLANE = 0,
    QUADSEG_SPHERE = 1,
    QUADSEG_CYLINDER = 2,
    QUADSEG_CONE = 3,
    QUADSEG_TORUS = 4,
    QUADSEG_ELLIPSOID = 5,
    QUADSEG_ELLIPTIC_CYLINDER = 6,
    QUADSEG_ELLIPTIC_CONE = 7,
    QUADSEG_ELLIPTIC_PARABOLOID = 8,
    QUADSEG_HYPERBOLIC_PARABOLOID = 9,
    QUADSEG_HYPERBOLOID_ONE_SHEET = 10,
    QUADSEG_HYPERBOLOID_TWO_SHEETS = 11,
    QUADSEG_PARABOLIC_CYLINDER = 12,
    QUADSEG_HYPERBOLIC_CYLINDER = 13,
    QUADSEG_QUADRIC = 14,
    QUADSEG_BLEND = 15,
    QUADSEG_FREEFORM = 16
};

/// A region and its surface, in the input's coordinates and unit. Fields that a type does not have are 0. No
/// struct_size: the call that fills an array of these takes it once.
typedef struct quadseg_region {
    int32_t id;          ///< its label
    int32_t type;        ///< QUADSEG_PLANE …
    int32_t surface_id;  ///< equal for regions that lie on one surface
    int32_t valid;       ///< 1: the foot points lie on one sheet and the normals agree
    int32_t outward;     ///< 1: the mesh normal points away from axis, centre or spine (boss, not hole)
    int32_t reserved;
    uint64_t faces;
    double area;              ///< input unit squared
    double rms, max;          ///< distances of the region's vertices to its surface, relative to the diagonal
    double energy;            ///< in the unit cube
    double coefficients[10];  ///< c · [1, x, y, z, x², xy, xz, y², yz, z²] = 0
    double point[3];  ///< plane: a point; sphere, torus, ellipsoid, hyperboloid: centre; cylinder: axis point; cone:
                      ///< apex
    double axis[3];   ///< unit. plane: normal (outward); cone: from the apex into the cone
    double radius;    ///< sphere, cylinder, blend; torus: major radius
    double minor_radius;  ///< torus
    double half_angle;    ///< cone, radians
    double axes[9];       ///< general quadrics: three unit principal axes, row by row
    double semi_axes[3];  ///< general quadrics, where they exist
} quadseg_region;

/// `region_size` = sizeof(quadseg_region); `capacity` ≥ summary.regions, in regions.
QUADSEG_API quadseg_status quadseg_segmentation_regions(const quadseg_segmentation* segmentation,
                                                        quadseg_region* regions, size_t region_size, size_t capacity);

/// One merge of the bottom-up flow.
typedef struct quadseg_merge {
    uint64_t regions;  ///< left after it
    double energy;     ///< estimate of the total energy at that point, unit cube
} quadseg_merge;

/// `capacity` ≥ summary.merges.
QUADSEG_API quadseg_status quadseg_segmentation_merges(const quadseg_segmentation* segmentation, quadseg_merge* merges,
                                                       size_t capacity);
/// Preset paper: the energy after every Lloyd iteration. `capacity` ≥ summary.energies.
QUADSEG_API quadseg_status quadseg_segmentation_energies(const quadseg_segmentation* segmentation, double* energies,
                                                         size_t capacity);
/// With options.project: 3 doubles a vertex, input order. `capacity` ≥ summary.projected.
QUADSEG_API quadseg_status quadseg_segmentation_projected(const quadseg_segmentation* segmentation, double* positions,
                                                          size_t capacity);

enum {
    QUADSEG_PARALLEL = 0,
    QUADSEG_PERPENDICULAR = 1,
    QUADSEG_COAXIAL = 2,
    QUADSEG_COPLANAR = 3,
    QUADSEG_CONCENTRIC = 4,
    QUADSEG_EQUAL_RADIUS = 5
};

/// Regions that share a direction, an axis, a radius …
typedef struct quadseg_regularity {
    uint32_t struct_size;
    int32_t kind;      ///< QUADSEG_PARALLEL …
    int32_t snapped;   ///< 1: the surfaces were made to follow it
    int32_t reserved;  ///< 0
    uint64_t regions;  ///< how many take part
} quadseg_regularity;

/// The regularity number `index` < summary.regularities. `regions` may be null when only the numbers are wanted, else
/// `capacity` ≥ its number of regions.
QUADSEG_API quadseg_status quadseg_segmentation_regularity(const quadseg_segmentation* segmentation, size_t index,
                                                           quadseg_regularity* regularity, int32_t* regions,
                                                           size_t capacity);

// ---- Segmenter: one prepared mesh, many operations (see Segmenter in segmenter.h)

/// A mesh, checked and prepared once, and its current partition. Faces are named by input index, regions by their
/// label, 0 … regions − 1 after every operation. One thread at a time. An operation that fails or is stopped changes
/// nothing.
typedef struct quadseg_segmenter quadseg_segmenter;

/// The arrays may go afterwards. The partition is one region a connected component. `options`, `context` may be null.
QUADSEG_API quadseg_status quadseg_segmenter_create(const quadseg_mesh_view* mesh, const quadseg_options* options,
                                                    quadseg_context* context, quadseg_segmenter** segmenter);
QUADSEG_API void quadseg_segmenter_destroy(quadseg_segmenter* segmenter);
/// For what follows; null: nothing watches, bounds or stops it. The segmenter keeps what it needs of the context.
QUADSEG_API quadseg_status quadseg_segmenter_set_context(quadseg_segmenter* segmenter, quadseg_context* context);
/// For what follows; null: the defaults. The partition stays and is fitted anew; forgets what could be undone.
QUADSEG_API quadseg_status quadseg_segmenter_set_options(quadseg_segmenter* segmenter, const quadseg_options* options);
/// The whole automatic segmentation, as quadseg_segment() under the segmenter's options. `stop` (QUADSEG_STOP_…) may be
/// null. Undoable.
QUADSEG_API quadseg_status quadseg_segmenter_run(quadseg_segmenter* segmenter, int32_t* stop);
/// Replaces the partition by any integers, `count` = faces; disconnected regions are split. Undoable.
QUADSEG_API quadseg_status quadseg_segmenter_set_labels(quadseg_segmenter* segmenter, const int32_t* labels,
                                                        size_t count);
enum { QUADSEG_WORST_FACE = -1 };
/// New region seeded at `face`, or where the partition is worst. `label` of the new region may be null. Undoable.
QUADSEG_API quadseg_status quadseg_segmenter_insert(quadseg_segmenter* segmenter, int64_t face, int32_t* label);
/// Merges two regions that touch. Undoable.
QUADSEG_API quadseg_status quadseg_segmenter_merge(quadseg_segmenter* segmenter, int32_t a, int32_t b);
/// The energy that the merge would add, and whether the common fit is valid (1 or 0). Changes nothing.
QUADSEG_API quadseg_status quadseg_segmenter_merge_candidate(const quadseg_segmenter* segmenter, int32_t a, int32_t b,
                                                             double* increase, int32_t* valid);
/// Up to `iterations` Lloyd iterations; `energy` after them may be null. Undoable.
QUADSEG_API quadseg_status quadseg_segmenter_relax(quadseg_segmenter* segmenter, int32_t iterations, double* energy);
/// Smooths the borders of regions. Undoable.
QUADSEG_API quadseg_status quadseg_segmenter_smooth(quadseg_segmenter* segmenter);
/// Takes the last undoable operation back; `undone` (1, or 0 when there is none) may be null.
QUADSEG_API quadseg_status quadseg_segmenter_undo(quadseg_segmenter* segmenter, int32_t* undone);
/// Of the current partition; 0 for null.
QUADSEG_API size_t quadseg_segmenter_regions(const quadseg_segmenter* segmenter);
/// `capacity` ≥ faces of the input.
QUADSEG_API quadseg_status quadseg_segmenter_labels(const quadseg_segmenter* segmenter, int32_t* labels,
                                                    size_t capacity);
/// The current partition as quadseg_segment() returns one.
QUADSEG_API quadseg_status quadseg_segmenter_result(const quadseg_segmenter* segmenter,
                                                    quadseg_segmentation** segmentation);

// ---- Names, for reports; "unknown" for other numbers. Never null.

QUADSEG_API const char* quadseg_phase_name(int32_t phase);
QUADSEG_API const char* quadseg_surface_type_name(int32_t type);
QUADSEG_API const char* quadseg_stop_name(int32_t stop);
QUADSEG_API const char* quadseg_regularity_name(int32_t kind);

// ---- Writing; under a temporary name, then renamed

/// By extension: .ply (binary), .off, .obj, .stl (binary).
QUADSEG_API quadseg_status quadseg_write_mesh(const char* path, const quadseg_mesh_view* mesh);
/// Binary PLY with one label a face (property int label) and one colour a face (3 bytes); each may be null.
QUADSEG_API quadseg_status quadseg_write_ply(const char* path, const quadseg_mesh_view* mesh, const int32_t* labels,
                                             const uint8_t* rgb);
/// One label a line for each of the mesh's faces, or for each polygon where it has them.
QUADSEG_API quadseg_status quadseg_write_labels(const char* path, const quadseg_mesh_view* mesh, const int32_t* labels);

#ifdef __cplusplus
}
#endif

#endif
