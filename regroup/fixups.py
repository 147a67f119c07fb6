S = "native/src/"
FIXUPS = [
    # comments that named a file which is now this one, or another
    (S + "base/file.h", "leaves the old file or the new one (base/file.h).", "leaves the old file or the new one (AtomicFile)."),
    (S + "brdf/fit/slice_sampling.h", "// of the light grid (brdf/fit/slice_sampling.h)", "// of the light grid (LightGrid)"),
    (S + "brdf/verdict/verdict.h", "with pictures of the measurement (brdf/verdict/verdict.h): good", "with pictures of the measurement (picture_pairs): good"),
    (S + "btf/model/tensor_evaluator.h", "reverse order (tensor_evaluator.h).", "reverse order (TensorEvaluator)."),
    (S + "btf/model/tensor_evaluator.h", "// order (tensor_images.h).", "// order (TensorImages)."),
    (S + "btf/model/tensor_btf.h", "(pair_interpolation.h)", "(PairInterpolation)"),
    (S + "usage/btf/scene_reduction.h", "by scene_reduction.h, between", "by least_size(), between"),
    (S + "usage/btf/scene_reduction.h", "options.for_scene (scene_refit.h) or", "options.for_scene (refit_for_scene) or"),
    (S + "usage/btf/scene_btf.h", "(half_image.h)", "(half_image)"),
    (S + "brdf/eval/parametric_table.h", "(parametric_nodes.h)", "(ParametricNodes)"),
    (S + "material/principled/principled_formulas-inl.h", "by principled_point.cpp for", "by principled_material.cpp for"),
    (S + "render/path/point_batch.cpp", "sobol.cpp explains", "math/sphere/random.cpp explains"),
    (S + "image/tensors/exr_tensors.h", "(tensor_pixels.h)", "(tensor_pack.h)"),
    (S + "brdf/formats/rgl_positions.cpp", "the polynomial of half_diff.h", "the polynomial of brdf_table.h"),
    (S + "plot/pen.cpp", "// The two layouts of a plot. Internal to plot/.", "// The two layouts of a plot."),
    ("native/tests/unit/capture/tile/knit_test.cpp", "as knit.h states it", "as fabrics.h states it"),
    ("native/tests/unit/light/environment_kernels_test.cpp", "/// As environment_kernels.h defines", "/// As environment_fit.h defines"),
    ("native/tests/unit/material/parametric_table_test.cpp", "as parametric_nodes.h measures it", "as parametric_table.h measures it"),
    # base
    (S + "base/README.md", "| `file.h`, `atomic_file.h`, `byte_reader.h` |", "| `file.h`, `byte_reader.h` |"),
    (S + "base/README.md", "| `scratch_pages.h`, `aligned_array.h`, `transposed.h` | memory that may lie in a file; aligned arrays; transposition |", "| `memory.h`, `transposed.h` | aligned arrays, arenas, memory that may lie in a file; transposition |"),
    # brdf
    (S + "brdf/README.md", "adds\n  lobes until every view meets its tolerance (`lobe_search` finds them, `solver` moves them).", "adds\n  lobes until every view meets its tolerance (`lobe_growth` finds them, `solver` moves them)."),
    (S + "brdf/README.md", "fits each view on its own (`slice_fit`, `slice_solver`).", "fits each view on its own (`slice_fit`)."),
    (S + "brdf/README.md", "reduces a parametric model to scene usage. `ggx_fit`,\n  `principled_fit` and `peer` fit analytic materials for comparison.", "reduces a parametric model to scene usage. `ggx_fit`\n  and `peer` fit analytic materials for comparison."),
    (S + "brdf/README.md", "comes from `parametric_table` (isotropic) or `parametric_values` (exact\n  splines). `parametric_nodes` finds the lobes that matter there. `table_sampler` samples tables of any material.", "comes from a table (isotropic) or from exact splines, both in\n  `parametric_table.h`; `parametric_nodes.cpp` finds the lobes that matter there. `table_sampler` samples tables of any\n  material."),
    (S + "brdf/README.md", "  (`entries.h`).", "  (`measure/measurement.h`)."),
    # btf
    (S + "btf/README.md", "- `companded_views`, `color_axes`: views as matrices, one per color axis\n- `fitted_sides`, `relief_pyramid`, `surface_points`, `shown_views`: the sides, their reliefs, and what views show of\n  them", "- `side_views`: views as matrices, one per color axis\n- `fitted_sides`, `relief_pyramid`, `seen_texels`: the sides, their reliefs, and what views show of them"),
    (S + "btf/README.md", "- `fit_checkpoint`, `fit_memory`: resuming, and the memory limit", "- `fit_checkpoint`, `btf_fitter`: resuming, and the memory limit"),
    # capi
    (S + "capi/README.md", "| `conversions.h` | colors, matrices, textures and options from the caller's form |", "| `conversions.h` | colors, matrices, textures, options and measured materials from the caller's form |"),
    (S + "capi/README.md", "| `*_reports.h`, `json_text.h` | reports as JSON,", "| `reports` | reports as JSON,"),
    # capture
    (S + "capture/README.md", "(`light_kernels`: SIMD). `view_store` holds the images of a view.", "(`light_kernels`: SIMD). A `ViewStore` holds the images of a view."),
    (S + "capture/README.md", "- `goniometer`: `height_field` makes the surface, `periodic_tile` traces it, `coated_body` is what lies below a clear\n  facet, `bins` and `pair_grid` collect light, `microsurface_brdf` estimates f, `microsurface` writes the table.", "- `goniometer`: `height_field` makes the surface and traces it, `coated_body` is what lies below a clear facet, `bins`\n  collect light, `goniometer` estimates f, `microsurface` writes the table."),
    (S + "capture/README.md", "- `tile`: `woven`, `chainmail` and `gravel` build the kinds of structure, with `mesh_builder`.", "- `tile`: `fabrics` and `bodies` build the kinds of structure, with `mesh_builder`."),
    # denoise
    (S + "denoise/README.md", "uses all three for", "uses it for"),
    (S + "denoise/README.md", "- `open_image_denoise.h` opens the library when it is first needed. Velour builds and runs without it.\n- `denoiser.h` filters one picture. Albedo and normals guide the filter and are filtered first.", "`denoiser.h`:\n\n- The library is opened when it is first needed. Velour builds and runs without it.\n- A `Denoiser` filters one picture. Albedo and normals guide the filter and are filtered first."),
    (S + "denoise/README.md", "- `halves.h` combines two independent halves of a picture's samples, each denoised on its own. Their differences\n  estimate the error, and the share of the noisy picture that makes it smallest.", "- Two independent halves of a picture's samples, each denoised on its own, are combined. Their differences estimate\n  the error, and the share of the noisy picture that makes it smallest."),
    # image
    (S + "image/image_stack.cpp", "refuse(", "refuse_stack(", 5),
    (S + "image/README.md", "1. `picture_format.h` recognizes a file by its first bytes.", "1. `picture_format_of` (`open_picture.h`) recognizes a file by its first bytes."),
    (S + "image/README.md", "and returns linear Rec. 709.\n   `orientation.h` and `color_primaries.h` hold the mathematics.\n4. `half_image.h` makes the next mip level.", "and returns linear Rec. 709.\n   `color_primaries.h` holds the mathematics of colors.\n4. `texels.h` interpolates texels and makes the next mip level.\n5. `image_stack.h` reads single images of a stack of images: the views of a captured BTF.\n6. `flip.h` is FLIP, the visible difference of two pictures."),
    (S + "image/README.md", "parts of pictures (`exr_part.h`) |", "parts of pictures (`exr_picture.h`) |"),
    (S + "image/README.md", "| `stack` | stacks of images from which single ones are read: the views of a captured BTF |\n| `flip` | FLIP, the visible difference of two pictures |\n", ""),
    # material
    (S + "material/README.md", "| `texture.h`, `texture_slot.h`, `footprint_taps.h` | textures averaged over footprints, in place of constants |", "| `texture.h` | textures averaged over footprints, in place of constants |"),
    (S + "material/README.md", "| `principled`, `glossy_material.h`, `rough_diffuse_material.h`, `glass_material.h` | Blender's Principled,", "| `principled`, `bsdf_materials.h` | Blender's Principled,"),
    (S + "material/README.md", "| `shader_layers.h`, `normal_map.h`, `through_material.h`, `placed_material.h` | mixes,", "| `shader_layers.h`, `normal_map.h`, `derived_materials.h` | mixes,"),
    # math
    (S + "math/README.md", "In `tensor`, `tensor_view.h` holds views, tensors and their unfoldings. `leading_vectors.h` finds bases,\n`decompositions.h` Tucker decompositions,", "In `tensor`, `tensor_view.h` holds views, tensors and their products. `decompositions.h` finds bases and Tucker\ndecompositions,"),
    (S + "math/README.md", "dimension (`sphere/random.h`, `sphere/sobol.h`).", "dimension (`sphere/random.h`)."),
    # model
    (S + "model/README.md", "`records.h` and `btf_record.h` define the records.", "`records.h` defines the records."),
    (S + "model/README.md", """- `model_file.h` writes and reads it as named tensors in an OpenEXR file (`image/tensors/exr_tensors.h`). Each kind
  has its own source: `parametric_file`, `per_view_file`, `factored_file`, `srbf_btf_file`, `tensor_btf_file`.
  `btf_sides.h` has what BTFs share, `shell_file.h` the VOTF.
- `model_fields.h` checks every field that is read. `record_json.h` and `scene_json.h` hold the records as text.
- `model_material.h` makes the material that is rendered.
""", """- `file/model_file.h` writes and reads it as named tensors in an OpenEXR file (`image/tensors/exr_tensors.h`). Each kind
  has its functions in `file/model_parts.h`; the sources are `brdf_parts`, `btf_parts`, with `btf_sides` for what BTFs
  share, and `shell_parts` for the VOTF.
- `file/model_fields.h` checks every field that is read. `file/record_json.h` holds the records as text.
- `make_material` (`model.h`) makes the material that is rendered.
"""),
    # plot
    (S + "plot/README.md", "each kind of plot: lobes (`lobes_plot.h`), order,", "each kind of plot: lobes (`lobes_plot.cpp`), order,"),
    (S + "plot/README.md", "2. `plot.h` holds them as a `Plot` of series and axes.", "2. `plot.h` holds them as a `Plot` of series and axes with ticks."),
    (S + "plot/README.md", "a `Drawing` of strokes, dots and labels. `layouts.cpp` knows\n   the layouts, `axes.h` the ticks.\n4. `raster.h` and `svg.h` draw it,", "a `Drawing` of strokes, dots and labels.\n4. `output.h` draws it as pixels or SVG,"),
    # realtime
    (S + "realtime/README.md", "| `btf_maps.h` | an SRBF BTF |", "| `maps.h` | an SRBF BTF |"),
    (S + "realtime/README.md", "| `votf_maps.h` | an `VotfVolume` |", "| `maps.h` | a `VotfVolume` |"),
    (S + "realtime/README.md", "`lobe_rows.cpp` takes the lobes of a view from `lobes_of_views.h` and turns them into Gaussians with\n`light_gaussians.h`. `exchanged_lobes.h` adds the second half of reciprocal models.", "`lobe_rows.cpp` takes the lobes of a view from `lobes_of_views.h`, which adds the second half of reciprocal models, and\nturns them into Gaussians with `light_gaussians.h`."),
    # render
    (S + "render/README.md", """2. `render.cpp` runs passes over blocks of pixels until all samples are taken, the noise is low enough
   (`noise_target.h`, `denoised_target.h`), or time is up. `progressive.h` serves the viewport, coarse images first.
3. `tile_renderer.h` is the work of one thread: it makes camera rays (`path_numbers.h`, `point_batch.h`) and advances
   their paths from bounce to bounce together (`paths_in_flight.h`).
4. `vertex.h` prepares a hit for shading: frame, footprint (`footprint.h`), the point behind a shell
   (`shell_crossing.h`).
5. `direct_light.h` samples directions from the surface (`direction_sampling.h`), from `lights` and from their
   products, and weights them; `direct_light_deltas.cpp` follows lobes without width. `continuation.h` continues the
   path.
6. `shadow_queue.h` traces the shadow rays of many vertices at once and adds the light that arrives to the camera
   samples.
7. `film` adds camera samples to pixels and returns them as passes.
""", """2. `render.cpp` runs passes over blocks of pixels until all samples are taken, the noise is low enough
   (`film/noise_target.h`), or time is up. `progressive.h` serves the viewport, coarse images first.
3. `tile_renderer.h` is the work of one thread: it makes camera rays (`path/path_numbers.h`) and advances their paths
   from bounce to bounce together (`path/paths_in_flight.h`).
4. `path/vertex.h` prepares a hit for shading: frame, footprint, the program's values, the point behind a shell
   (`path/shell_crossing.h`).
5. `path/direct_light.h` samples directions from the surface (`path/direction_sampling.h`, which continues the path,
   too), from `lights` and from their products, and weights them; `path/direct_light_deltas.cpp` follows lobes without
   width.
6. `path/shadow_queue.h` traces the shadow rays of many vertices at once and adds the light that arrives to the camera
   samples.
7. `film` adds camera samples to pixels and returns them as passes.
"""),
    (S + "render/README.md", "In `lights`, `lighting.h` chooses among all light and `light_tree.h` among near lights. `area_light.h`,\n`delta_light.h`, `emissive_meshes.h` and `environment_proposals.h` sample one kind each. `ray_log.h`", "In `lights`, `lighting.h` chooses among all light, delta lights included, and `light_tree.h` among near lights.\n`area_light.h`, `emissive_meshes.h` and `environment_proposals.h` sample one kind each. `ray_log.h`"),
    (S + "render/README.md", "- Ask `VisibleRays` (`shadow_queue.h`) for hits", "- Ask `VisibleRays` (`path/shadow_queue.h`) for hits"),
    # scene
    (S + "scene/README.md", "1. `mesh_arrays.h` borrows the caller's arrays; `mesh.h` copies them, leaves out triangles that rays cannot hit, and\n   makes normals and tangents. `mesh_file.h` reads meshes from files (`obj_file.h`, `ply_file.h`).", "1. `MeshArrays` borrow the caller's arrays; a `Mesh` copies them, leaves out triangles that rays cannot hit, and makes\n   normals and tangents. `mesh_file.h` reads meshes from files (`obj_file.cpp`, `ply_file.cpp`)."),
    # usage
    (S + "usage/README.md", "records the hits of one material (`scene_observer.h`, with\n   `view_tracer.h` and `hit_light.h`).", "records the hits of one material (`scene_observer.h`, with\n   `hits.h`)."),
    (S + "usage/README.md", "Observations of several frames merge. `observation_file.h` is their file, `observation_hash.h`\n   their hash.", "Observations of several frames merge, have a hash and are kept in files."),
    (S + "usage/README.md", "`picture_error.h` and `btf/seen_pictures.h` estimate", "`PictureError` and `SeenPictures` estimate"),
    # votf
    (S + "votf/README.md", "- From data (`data_votf`): `shell_fusion` combines the views of a BTF.\n- At run time: `votf_volume` is the data, `shell_field` its look-up. `shell_trace` follows rays (`shell_kernels`:\n  SIMD), `shell_depth` finds the silhouette beside a ray, `visibility_mask` is V of a whole tile.", "- From data (`data_votf`): combines the views of a BTF.\n- At run time: `occlusion_volume` is the data, its look-up and V of a whole tile. `shell_trace` follows rays\n  (`shell_kernels`: SIMD; `shell_depth`: the silhouette beside a ray)."),
    (S + "votf/README.md", "knows the curved surface. The file is `model/file/model_parts.h`, the\nviewport's table `realtime/maps.h`.", "knows the curved surface. The file is in\n`model/file/shell_parts.cpp`, the viewport's table in `realtime/maps.h`."),
    # documents
    ("docs/engine/architecture.md", "7. `native/src/render/path/vertex.cpp`: frame, footprint, texture coordinates, material and [program](programs.md) of a hit.", "7. `native/src/render/path/vertex.cpp`: frame, footprint, texture coordinates, material and [program](programs.md) of a\n   hit."),
    ("docs/engine/votf.md", "get sides; UV seams are no borders. `ShellCrossing` (`native/src/render/path/shell_crossing.h`) decides every camera, shadow\nand bounce ray that crosses the top or a side.", "get sides; UV seams are no borders. `ShellCrossing` (`native/src/render/path/shell_crossing.h`) decides every camera,\nshadow and bounce ray that crosses the top or a side."),
    ("docs/engine/btf_fitting.md", "(`direction_bases`, `reduced_texels`).", "(`direction_bases`)."),
    ("docs/engine/btf_fitting.md", "(`fit_memory.h`)", "(`btf_fitter.h`)"),
    ("docs/engine/ggx_and_principled.md", "`native/src/brdf/fit`: `ggx_fit`, `principled_fit`, `pair_samples`;", "`native/src/brdf/fit`: `ggx_fit`, `peer`;"),
    ("docs/engine/mesostructures.md", "(constants: `knit.h`)", "(constants: `fabrics.h`)"),
    ("docs/engine/noise.md", "Code: `native/src/render`: `path_numbers`, `noise_target`, `denoised_target`, `options.h`, `film`;\n`native/src/math/sphere`: `sobol`, `random.h`;", "Code: `native/src/render`: `path/path_numbers`, `film/noise_target`, `options.h`, `film`;\n`native/src/math/sphere`: `random`;"),
    ("docs/engine/light_sampling.md", "`native/src/render`: `vertex`, `shadow_queue`;", "`native/src/render/path`: `vertex`, `shadow_queue`;"),
    ("docs/engine/strategies.md", "`render/direct_light`, `render/direction_sampling`, `render/lights/environment_proposals`;", "`render/path/direct_light`, `render/path/direction_sampling`,\n`render/lights/environment_proposals`;"),
    ("docs/engine/scene_usage.md", "2. **Refit** (`scene_refit.h`).", "2. **Refit** (`refit_for_scene`)."),
]
