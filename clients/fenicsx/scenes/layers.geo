// Two layers of a block 0.5 x 0.4 x 1 m, unstructured tetrahedra. gmsh -3 -format msh41 layers.geo -o layers.msh
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 0.5, 0.4, 0.5};
Box(2) = {0, 0, 0.5, 0.5, 0.4, 0.5};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Physical Volume("lower") = {1};
Physical Volume("upper") = {2};
Physical Surface("left") = Surface In BoundingBox{-0.01, -1, -1, 0.01, 2, 2};
Physical Surface("right") = Surface In BoundingBox{0.49, -1, -1, 0.51, 2, 2};
Physical Surface("front") = Surface In BoundingBox{-1, -0.01, -1, 2, 0.01, 2};
Physical Surface("back") = Surface In BoundingBox{-1, 0.39, -1, 2, 0.41, 2};
Physical Surface("bottom") = Surface In BoundingBox{-1, -1, -0.01, 2, 2, 0.01};
Physical Surface("top") = Surface In BoundingBox{-1, -1, 0.99, 2, 2, 1.01};
Mesh.MeshSizeMax = 0.14;
MeshSize { PointsOf{ Surface{:}; } } = 0.14;
