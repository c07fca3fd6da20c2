declare module 'draco3d/draco_encoder_nodejs.js' {
  interface Mesh {
    readonly brand: 'mesh';
  }
  interface Int8Array {
    GetValue(index: number): number;
  }
  interface MeshBuilder {
    AddFacesToMesh(mesh: Mesh, faces: number, indices: Uint32Array): boolean;
    AddUInt16Attribute(mesh: Mesh, type: number, vertices: number, components: number, values: Uint16Array): number;
    AddUInt8Attribute(mesh: Mesh, type: number, vertices: number, components: number, values: Uint8Array): number;
    AddFloatAttribute(mesh: Mesh, type: number, vertices: number, components: number, values: Float32Array): number;
  }
  interface Encoder {
    SetEncodingMethod(method: number): void;
    SetAttributeQuantization(type: number, bits: number): void;
    EncodeMeshToDracoBuffer(mesh: Mesh, bytes: Int8Array): number;
  }
  interface EncoderModule {
    MeshBuilder: new () => MeshBuilder;
    Mesh: new () => Mesh;
    Encoder: new () => Encoder;
    DracoInt8Array: new () => Int8Array;
    POSITION: number;
    NORMAL: number;
    GENERIC: number;
    MESH_EDGEBREAKER_ENCODING: number;
  }
  const createModule: () => Promise<EncoderModule>;
  export default createModule;
}

declare module 'gltf-validator' {
  interface Report {
    readonly issues: {
      readonly numErrors: number;
      readonly numWarnings: number;
      readonly messages: readonly { readonly code: string; readonly message: string; readonly severity: number }[];
    };
  }
  export function validateBytes(data: Uint8Array): Promise<Report>;
}
