// Two balls and a ground of brushed metal. Bumps finer than any pixel send each ray another way, so
// that a pixel is the mean of independent samples: its error falls as their number's root.
// Declare=Samples=N rays a pixel (through a lens too small to blur), Declare=Seed=N other bumps,
// Declare=Plate=1 the ground alone, from above: no edge in the picture.
#version 3.7;
global_settings { assumed_gamma 1.0 }
#ifndef (Seed) #declare Seed = 1; #end
#ifndef (Samples) #declare Samples = 4; #end
#ifndef (Plate) #declare Plate = 0; #end

camera {
  location <0, 1, -3.2> look_at <0, 0.8 - 0.8 * Plate, -2.4 * Plate>
  right x * image_width / image_height angle 50
  // In focus just before the lens: nowhere do the samples of a pixel meet in one point.
  aperture 0.0006 focal_point <0, 0.99, -3> blur_samples Samples variance 0 confidence 0.5
}
light_source { <-1, 3, -2> color rgb 1.2 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.9, 0.85, 0.8>] [1 rgb <0.2, 0.4, 0.9>] } } }

#macro Brushed(Tint)
  texture {
    pigment { rgb 0.1 * Tint }
    normal { bumps 0.6 scale 3e-4 translate 7.31 * Seed * <1, 2, 3> }
    finish { ambient 0 diffuse 0.3 reflection { rgb 0.8 * Tint } }
  }
#end
plane { y, 0 Brushed(<1, 1, 1>) }
#if (!Plate)
sphere { <-0.55, 0.55, 0.2>, 0.55 Brushed(<1, 0.8, 0.5>) }
sphere { <0.6, 0.4, -0.1>, 0.4 Brushed(<0.6, 0.8, 1>) }
#end
