// A ball of `facets` facets around.
facets = 8;
sphere(r = 10, $fn = facets);
