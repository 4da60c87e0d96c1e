// A slider that moves by itself.  It tells by "drag" its place, and whether it is let go: of a step by a key it is.
export default {
  template: `<q-slider :model-value="at" @update:model-value="move" @pointerdown="hold" @pan="pan" />`,
  props: { modelValue: Number },
  emits: ["drag"],
  data() {
    return { at: this.modelValue, held: false, panned: false };
  },
  watch: {
    modelValue(at) {
      this.at = at;
    },
  },
  methods: {
    move(at) {
      this.at = at;
      this.$emit("drag", at, !this.held);
    },
    hold() {
      this.held = true;
      const up = () => this.panned || this.letGo(); // after a pan its last move comes later
      for (const end of ["pointerup", "pointercancel"]) window.addEventListener(end, up, { once: true });
    },
    pan(phase) {
      this.panned = phase === "start";
      if (this.panned) this.held = true;
      else this.letGo();
    },
    letGo() {
      if (this.held) this.$emit("drag", this.at, true);
      this.held = false;
    },
  },
};
