export { AmbientLight, BoxGeometry, BufferAttribute, BufferGeometry, Color, CylinderGeometry, DirectionalLight, DoubleSide, EdgesGeometry, GridHelper, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, MeshBasicMaterial, PerspectiveCamera, Scene, Vector3, Box3, WebGLRenderer } from 'three';
export { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
