// The part of Draco's WebAssembly decoder that is used here: the package brings no types.
declare module 'draco3d/draco_decoder_nodejs.js' {
  export interface DracoStatus {
    ok(): boolean;
    error_msg(): string;
  }
  export interface DracoAttribute {
    num_components(): number;
    unique_id(): number;
    data_type(): number;
  }
  export interface DracoMesh {
    num_faces(): number;
    num_points(): number;
    num_attributes(): number;
  }
  export interface DracoDecoder {
    DecodeArrayToMesh(bytes: Uint8Array, size: number, mesh: DracoMesh): DracoStatus;
    GetAttributeId(mesh: DracoMesh, type: number): number;
    GetAttribute(mesh: DracoMesh, id: number): DracoAttribute;
    GetAttributeByUniqueId(mesh: DracoMesh, id: number): DracoAttribute;
    GetAttributeDataArrayForAllPoints(
      mesh: DracoMesh,
      attribute: DracoAttribute,
      type: number,
      bytes: number,
      to: number,
    ): boolean;
    GetTrianglesUInt32Array(mesh: DracoMesh, bytes: number, to: number): boolean;
  }
  export interface DracoModule {
    Decoder: new () => DracoDecoder;
    Mesh: new () => DracoMesh;
    destroy(object: DracoDecoder | DracoMesh | DracoStatus): void;
    _malloc(bytes: number): number;
    _free(address: number): void;
    HEAPU8: Uint8Array;
    POSITION: number;
    NORMAL: number;
    DT_UINT8: number;
    DT_UINT16: number;
    DT_INT32: number;
    DT_UINT32: number;
    DT_FLOAT32: number;
  }
  const createModule: (options?: { wasmBinary?: ArrayBuffer }) => Promise<DracoModule>;
  export default createModule;
}
